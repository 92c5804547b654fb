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
#include <utility>
#include <vector>

namespace pcl_bsh::python {

namespace py = pybind11;

/// An array that owns what the vector held. @param numbersIn from the vector to its first number
template <class Number, class T>
py::array_t<Number> arrayOwning(std::vector<T>&& values, const Number* (*numbersIn)(const std::vector<T>&))
{
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const std::vector<T>& held = *owned;
  const py::capsule free(owned.release(), [](void* memory) { delete static_cast<std::vector<T>*>(memory); });
  return py::array_t<Number>(static_cast<py::ssize_t>(held.size()), numbersIn(held), free);
}

template <class T>
py::array_t<T> arrayFrom(std::vector<T>&& values)
{
  return arrayOwning<T, T>(std::move(values), [](const std::vector<T>& held) { return held.data(); });
}

/// Verdicts are bytes.
inline py::array_t<std::uint8_t> arrayFrom(std::vector<Verdict>&& verdicts)
{
  return arrayOwning<std::uint8_t, Verdict>(std::move(verdicts),
                                            [](const std::vector<Verdict>& held) { return bytesOf(held); });
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

inline py::array_t<std::uint8_t> arrayIn(const py::handle& object, const std::vector<Verdict>& verdicts)
{
  return arrayIn(object, bytesOf(verdicts), {static_cast<py::ssize_t>(verdicts.size())});
}

/// A read-only property: the array of one of the object's vectors.
template <class Object, class T>
auto column(std::vector<T> Object::*values)
{
  return [values](const py::object& self) { return arrayIn(self, self.cast<const Object&>().*values); };
}

/// (pairs, 2)
inline py::array_t<std::uint32_t> arrayFrom(const std::vector<PointPair>& pairs)
{
  py::array_t<std::uint32_t> array({pairs.size(), std::size_t{2}});
  std::uint32_t* record = array.mutable_data();
  for (const PointPair& pair : pairs) {
    *record++ = pair.a;
    *record++ = pair.b;
  }
  return array;
}

inline py::dict dictOf(const RefitReport& report)
{
  return py::dict("sorted_anew"_a = report.sorted_anew, "voxels_refitted"_a = report.voxels_refitted,
                  "voxels_dropped"_a = report.voxels_dropped, "volumes_refitted"_a = report.volumes_refitted,
                  "looseness"_a = report.looseness);
}

/// (4, 4)
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
