// SPDX-License-Identifier: BSD-3-Clause
// Results as NumPy arrays, without copies of their numbers.
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/query/result.h>

#include <pybind11/numpy.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh::python {

namespace py = pybind11;

/// An array that owns what the vector held.
template <class T>
py::array_t<T> arrayFrom(std::vector<T>&& values)
{
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const std::vector<T>& held = *owned;
  const py::capsule free(owned.release(), [](void* memory) { delete static_cast<std::vector<T>*>(memory); });
  return py::array_t<T>(static_cast<py::ssize_t>(held.size()), held.data(), free);
}

/// A read-only array of any shape in the memory of an object, which it keeps alive.
template <class T>
py::array_t<T> arrayIn(const py::handle& object, const T* data, std::vector<py::ssize_t> shape)
{
  py::array_t<T> array(std::move(shape), data, object);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <class T>
py::array_t<T> arrayIn(const py::handle& object, const std::vector<T>& values)
{
  return arrayIn(object, values.data(), {static_cast<py::ssize_t>(values.size())});
}

/// None where nothing was asked for: an empty vector beside a cloud that is not.
template <class T>
py::object arrayInOrNone(const py::handle& object, const std::vector<T>& values, bool asked)
{
  if (!asked) return py::none();
  return arrayIn(object, values);
}

inline py::dict dictOf(const RefitReport& report)
{
  py::dict named;
  named["sorted_anew"] = report.sorted_anew;
  named["voxels_refitted"] = report.voxels_refitted;
  named["voxels_dropped"] = report.voxels_dropped;
  named["volumes_refitted"] = report.volumes_refitted;
  named["looseness"] = report.looseness;
  return named;
}

/// (4, 4)
inline py::array_t<double> arrayOf(const Eigen::Isometry3d& pose)
{
  py::array_t<double> array({4, 4});
  for (py::ssize_t i = 0; i < 4; ++i)
    for (py::ssize_t k = 0; k < 4; ++k) array.mutable_at(i, k) = pose.matrix()(i, k);
  return array;
}

inline py::tuple tupleOf(const Interval& interval)
{
  return py::make_tuple(interval.lower, interval.upper);
}

inline py::object tupleOf(const std::optional<PointPair>& pair)
{
  if (!pair) return py::none();
  return py::make_tuple(pair->a, pair->b);
}

} // namespace pcl_bsh::python
