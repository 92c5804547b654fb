// SPDX-License-Identifier: BSD-3-Clause
// Between queries, which run without the interpreter's lock, and what Python wants to be told.
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
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

/// Where a hierarchy's points are; other threads may change it meanwhile.
inline PointsView viewNow(const SphereHierarchy& hierarchy)
{
  return unlocked([&] { return hierarchy.view(); });
}

/// Changes points of a hierarchy: while no query runs, and none begins.
/// @param prepare what is passed to `change`, which outlives that; may call Python
/// @param change without the interpreter's lock
template <class Prepare, class Change>
auto whileNoneComputes(Prepare&& prepare, Change&& change)
{
  std::optional<Changing> turn;
  {
    const py::gil_scoped_release release;
    turn.emplace();
  }
  const auto prepared = prepare();
  const py::gil_scoped_release release;
  return change(prepared);
}

} // namespace pcl_bsh::python
