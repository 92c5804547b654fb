// SPDX-License-Identifier: BSD-3-Clause
// Turns of Python's threads. At any time there are queries, or one change of points, or a fork, or the interpreter's
// end.
#pragma once

namespace pcl_bsh::python {

/// While it lives, this thread computes, and no hierarchy changes. May be nested: a query may be asked by the callback
/// of another. To be made without the interpreter's lock.
class Computing {
public:
  Computing();
  ~Computing();
  Computing(const Computing&) = delete;
  Computing& operator=(const Computing&) = delete;
};

/// While it lives, no other thread computes. It waits until running queries end. Later queries let it go first for a
/// while, and wait for its end. To be made without the interpreter's lock. Queries of this thread need not wait.
class Changing {
public:
  /// @throws std::runtime_error where this thread computes: in the callback of a query
  Changing();
  ~Changing();
  Changing(const Changing&) = delete;
  Changing& operator=(const Changing&) = delete;
};

/// Lets the interpreter fork only while no other thread computes or changes points. The child has none of these
/// threads, and would never finish their work. A fork waits for their queries, and later ones for the fork. In the
/// callback of a query it waits for none. The interpreter ends when no thread computes, too. Queries that report
/// progress are stopped, and those of daemon threads that begin later wait for ever. Needs the interpreter's lock; to
/// be called once.
void takeTurnsWithInterpreter();

} // namespace pcl_bsh::python
