// SPDX-License-Identifier: BSD-3-Clause
// A hierarchy reads the caller's array where it is, so the array must not change: it is read-only meanwhile.
#pragma once

#include <pybind11/numpy.h>

#include <vector>

namespace pcl_bsh::python {

/// Clears the flag `writeable` of an array and of the arrays that it is a view of. The destructor sets the flag again
/// where it was set, unless another lock holds the array. Both need the interpreter's lock.
class ArrayLock {
public:
  ArrayLock() = default;
  explicit ArrayLock(const pybind11::array& array);
  ~ArrayLock();
  ArrayLock(const ArrayLock&) = delete;
  ArrayLock& operator=(const ArrayLock&) = delete;

private:
  std::vector<pybind11::array> arrays_; ///< those of which this lock holds the flag
};

} // namespace pcl_bsh::python
