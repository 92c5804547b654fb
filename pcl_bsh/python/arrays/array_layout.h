// SPDX-License-Identifier: BSD-3-Clause
// Where in memory the coordinates of NumPy's arrays are: in place where a PointsView can read them, else in a copy.
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <pybind11/numpy.h>

#include <optional>
#include <string>

namespace pcl_bsh::python {

namespace py = pybind11;

std::string shapeOf(const py::array& array);
std::string nameOfType(const py::dtype& type);

/// As numpy.asarray(): an array is returned as it is. @throws InvalidInput for masked arrays, and for what is no array
py::array asArray(const std::string& name, const py::object& object, Input input = Input::points);

/// The scalar of a dtype; none unless that is float32 or float64 in this machine's byte order.
std::optional<Scalar> scalarOf(const py::dtype& type);

/// The view of rows, or of records with fields x, y, z. Errors call them `name`. The array becomes the copy, where one
/// is needed or wanted; `in_place` is set where no copy was made.
PointsView viewOfArray(const std::string& name, py::array& array, bool copy, bool& in_place);

} // namespace pcl_bsh::python
