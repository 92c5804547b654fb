// SPDX-License-Identifier: BSD-3-Clause
// How queries, which run without the interpreter's lock, report to Python and hear of Ctrl-C and of changes.
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/python/threads/computing.h>
#include <pcl_bsh/python/threads/interpreter_lock.h>
#include <pcl_bsh/query/progress.h>

#include <pybind11/pybind11.h>

#include <cstddef>
#include <functional>
#include <optional>

namespace pcl_bsh::python {

namespace py = pybind11;

/// Whether a callback's answer stops the query: Python's False or NumPy's does. None and all others let it go on.
inline bool isFalse(const py::object& answer)
{
  static PyObject* numpys = nullptr; // guarded by the interpreter's lock
  if (!numpys) numpys = py::object(py::module_::import("numpy").attr("bool_")).release().ptr();
  return (py::isinstance<py::bool_>(answer) || py::isinstance(answer, py::handle(numpys))) && !py::bool_(answer);
}

/// Whether a query goes on: not when the interpreter ends. Needs to be asked without the interpreter's lock.
/// @throws py::error_already_set of KeyboardInterrupt, after Ctrl-C
inline bool goesOn(double)
{
  if (isEnding()) return false;
  const Locked lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  return true;
}

/// Calls f(fraction), which stops the query by returning False; f may be None. The query must be called without the
/// interpreter's lock.
inline std::function<bool(double)> progressOf(const py::object& f)
{
  return [&f](double fraction) {
    if (!goesOn(fraction)) return false;
    if (f.is_none()) return true;
    const Locked lock;
    return !isFalse(called(f, py::float_(fraction)));
  };
}

/// Computes without the interpreter's lock. Ctrl-C ends it with KeyboardInterrupt, whether it reports progress or not.
template <class Compute>
auto unlocked(Compute&& compute)
{
  const Unlocked unlocked;
  const Computing turn;
  const std::function<bool(double)> report = goesOn;
  const Progress watched(report);
  return compute();
}

/// The view of a hierarchy, read while no other thread changes it.
inline PointsView viewNow(const SphereHierarchy& hierarchy)
{
  return unlocked([&] { return hierarchy.view(); });
}

/// How many threads change points, or wait to do so. Needs the interpreter's lock: while it is 0 and the lock is held,
/// the views of hierarchies stay.
inline std::size_t& changesBegun()
{
  static std::size_t count = 0;
  return count;
}

/// Changes points of a hierarchy: while no query runs, and none begins.
/// @param prepare called with the interpreter's lock. Its result is passed to `change`, and destroyed with the lock
/// @param change called without the interpreter's lock
template <class Prepare, class Change>
auto whileNoneComputes(Prepare&& prepare, Change&& change)
{
  struct Begun {
    Begun() { ++changesBegun(); }
    ~Begun() { --changesBegun(); }
  } const begun;
  std::optional<Changing> turn;
  {
    const Unlocked unlocked;
    turn.emplace();
  }
  const auto prepared = prepare();
  const Unlocked unlocked;
  struct Ends { // ends the turn before this thread waits for the interpreter's lock, which it may not get
    ~Ends() { turn.reset(); }
    std::optional<Changing>& turn;
  } const ends{turn};
  return change(prepared);
}

} // namespace pcl_bsh::python
