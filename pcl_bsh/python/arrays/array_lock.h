// SPDX-License-Identifier: BSD-3-Clause
// A hierarchy reads the caller's array where it is, so the array must not change: it is read-only meanwhile.
#pragma once

#include <pybind11/numpy.h>

#include <vector>

namespace pcl_bsh::python {

/// Clears the flag `writeable` of an array and of the arrays that it shows memory of: its base, the base of that, and
/// so on. Where the flag was set, it is set again as soon as no lock reads memory that the array shows. Keeps the
/// array. All of it needs the interpreter's lock.
class ArrayLock {
public:
  explicit ArrayLock(const pybind11::array& array);
  ~ArrayLock();
  ArrayLock(const ArrayLock&) = delete;
  ArrayLock& operator=(const ArrayLock&) = delete;

  /// Appends what it has references to: an array for each reference.
  void addReferences(std::vector<PyObject*>& references) const;

private:
  bool reads(const pybind11::array& array) const;

  pybind11::array array_;
  const PyObject* root_ = nullptr;      ///< the last base, which the memory belongs to
  std::vector<pybind11::array> locked_; ///< arrays whose flag this lock sets again, or has another lock set
};

/// The object whose memory an array, or another object between arrays, shows; null: no other object.
pybind11::object baseOf(const pybind11::object& object);

} // namespace pcl_bsh::python
