// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/python/array_lock.h>

#include <cstddef>
#include <unordered_map>

namespace pcl_bsh::python {
namespace {

namespace py = pybind11;

int& flagsOf(const py::array& array)
{
  return py::detail::array_proxy(array.ptr())->flags;
}

constexpr int kWriteable = py::detail::npy_api::NPY_ARRAY_WRITEABLE_;

/// How many locks hold an array that was writeable. A lock holds a reference, so the address stays that of the array.
std::unordered_map<const PyObject*, std::size_t>& holders()
{
  static std::unordered_map<const PyObject*, std::size_t> counts;
  return counts;
}

} // namespace

ArrayLock::ArrayLock(const py::array& array)
{
  for (py::object next = array; next && py::isinstance<py::array>(next);) {
    auto held = py::reinterpret_borrow<py::array>(next);
    const auto known = holders().find(held.ptr());
    if (known != holders().end() || held.writeable()) {
      arrays_.push_back(held);
      ++holders()[held.ptr()];
      flagsOf(held) &= ~kWriteable;
    }
    next = held.base();
  }
}

ArrayLock::~ArrayLock()
{
  for (const py::array& array : arrays_) {
    const auto known = holders().find(array.ptr());
    if (--known->second > 0) continue;
    holders().erase(known);
    flagsOf(array) |= kWriteable;
  }
}

} // namespace pcl_bsh::python
