// SPDX-License-Identifier: BSD-3-Clause
// Where in memory NumPy's arrays have coordinates: as a view reads them, or as a copy does where no view can.
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

/// As numpy.asarray(): an array stays what it is.
py::array asArray(const std::string& name, const py::object& object, Input input = Input::points);

/// None of integers, and of numbers in the other order of bytes.
std::optional<Scalar> scalarOf(const py::dtype& type);

/// The view of rows, or of records with fields x, y, z. Errors call them `name`. The array becomes the copy, where one
/// is needed or wanted; `in_place` is set where no copy was made.
PointsView viewOfArray(const std::string& name, py::array& array, bool copy, bool& in_place);

} // namespace pcl_bsh::python
