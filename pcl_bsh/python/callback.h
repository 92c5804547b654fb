// SPDX-License-Identifier: BSD-3-Clause
// Between queries, which run without the interpreter's lock, and what Python wants to be told.
#pragma once

#include <pcl_bsh/python/computing.h>

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>

namespace pcl_bsh::python {

namespace py = pybind11;

/// Calls f(fraction), which stops the query by returning False. Without f, too, Ctrl-C ends the query with
/// KeyboardInterrupt. The query must be called without the interpreter's lock.
inline std::function<bool(double)> progressOf(const py::object& f)
{
  return [&f](double fraction) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (f.is_none()) return true;
    const py::object answer = f(fraction);
    return !(py::isinstance<py::bool_>(answer) && !answer.cast<bool>());
  };
}

/// Computes without the interpreter's lock.
template <class Compute>
auto unlocked(Compute&& compute)
{
  const py::gil_scoped_release release;
  const Computing turn;
  return compute();
}

/// Changes points of a hierarchy: when no query runs, and with the interpreter's lock, so that none begins meanwhile.
template <class Change>
auto whileNoneComputes(Change&& change)
{
  std::optional<Changing> turn;
  {
    const py::gil_scoped_release release;
    turn.emplace();
  }
  return change();
}

} // namespace pcl_bsh::python
