// SPDX-License-Identifier: BSD-3-Clause
// Results as NumPy arrays, without copies of their numbers.
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/python/typed.h>
#include <pcl_bsh/query/result.h>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pcl_bsh::python {

namespace py = pybind11;

/// Values as arrays have them: verdicts as bytes; records, which are below 2^31, as int32, so that kNothing is -1.
template <class T>
const auto* numbersIn(const T* values)
{
  if constexpr (std::is_same_v<T, Verdict>)
    return reinterpret_cast<const std::uint8_t*>(values);
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return reinterpret_cast<const std::int32_t*>(values);
  else
    return values;
}

template <class T>
using ArrayOf = py::array_t<std::decay_t<decltype(*numbersIn(static_cast<const T*>(nullptr)))>>;

/// An array that owns what the vector held.
template <class T>
ArrayOf<T> arrayFrom(std::vector<T>&& values)
{
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const std::vector<T>& held = *owned;
  const py::capsule free(owned.release(), [](void* memory) { delete static_cast<std::vector<T>*>(memory); });
  return ArrayOf<T>(static_cast<py::ssize_t>(held.size()), numbersIn(held.data()), free);
}

/// A read-only array of any shape in the memory of an object, which it keeps alive. @param strides in bytes; none:
/// the numbers are contiguous
template <class T>
ArrayOf<T> arrayIn(const py::handle& object, const T* data, std::vector<py::ssize_t> shape,
                   std::vector<py::ssize_t> strides = {})
{
  ArrayOf<T> array(std::move(shape), std::move(strides), numbersIn(data), object);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <class T>
ArrayOf<T> arrayIn(const py::handle& object, const std::vector<T>& values)
{
  return arrayIn(object, values.data(), {static_cast<py::ssize_t>(values.size())});
}

/// A read-only property: the array of one of the object's vectors.
template <class Object, class T>
auto column(std::vector<T> Object::*values)
{
  return [values](const py::object& self) { return arrayIn(self, self.cast<const Object&>().*values); };
}

/// An array (pairs, 2) of the records a and b.
inline py::array_t<std::int32_t> arrayFrom(const std::vector<PointPair>& pairs)
{
  py::array_t<std::int32_t> array({pairs.size(), std::size_t{2}});
  std::int32_t* record = array.mutable_data();
  for (const PointPair& pair : pairs) {
    *record++ = static_cast<std::int32_t>(pair.a);
    *record++ = static_cast<std::int32_t>(pair.b);
  }
  return array;
}

inline py::dict dictOf(const RefitReport& report)
{
  return py::dict("sorted_anew"_a = report.sorted_anew, "voxels_refitted"_a = report.voxels_refitted,
                  "voxels_dropped"_a = report.voxels_dropped, "volumes_refitted"_a = report.volumes_refitted,
                  "looseness"_a = report.looseness);
}

/// A pose as an array (4, 4).
inline py::array_t<double> arrayOf(const Eigen::Isometry3d& pose)
{
  py::array_t<double> array({4, 4});
  for (py::ssize_t i = 0; i < 4; ++i)
    for (py::ssize_t k = 0; k < 4; ++k) array.mutable_at(i, k) = pose.matrix()(i, k);
  return array;
}

inline std::pair<double, double> tupleOf(const Interval& interval)
{
  return {interval.lower, interval.upper};
}

inline std::pair<std::uint32_t, std::uint32_t> tupleOf(const PointPair& pair)
{
  return {pair.a, pair.b};
}

inline std::optional<std::pair<std::uint32_t, std::uint32_t>> tupleOf(const std::optional<PointPair>& pair)
{
  if (!pair) return std::nullopt;
  return tupleOf(*pair);
}

/// "1.0", "nan": as Python writes it.
inline std::string numberText(double number)
{
  return py::repr(py::float_(number));
}

} // namespace pcl_bsh::python
