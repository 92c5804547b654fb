// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/tracks/axis_file.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/track/axis.h>

#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::python {
namespace {

constexpr auto kAxis =
    R"(The line that a vehicle follows: straights, arcs and clothoids in plan, heights, and cant.

Right is positive. Distances and chainages are counted in plan. `Axis.read` and `Axis.elements` make one from a file and
from text.

Parameters
----------
points : array_like, (n, 3)
    Measured; two arcs join each to the next, without a kink. With `fit`, few arcs are near them.
chainages : array_like, (n,)
    Chainages of the points; they rise.
cants : array_like, (n,), optional
    How much higher the left rail is.
gauge : float, default 1.5
    Between the rails' heads, whose heights cant tells.
pivot : str, default low_rail
    The line that cant turns about: low_rail, whose height is the axis', or centre.
most_turn : float, default 0.2
    The line may turn by so many radians at a point.
fit : float, optional
    How far from the arcs a point may be, as points err; `deviation` tells how far they are.

Raises
------
ValueError
    Naming the chainage where it is no axis.

Examples
--------
>>> import pcl_bsh
>>> axis = pcl_bsh.Axis([[0, 0, 0], [50, 0, 0], [100, 0, 1]], [1000, 1050, 1100])
>>> axis.length, axis.chainage(30.0), axis.distances_at(1060.0)
(100.0, 1030.0, [60.0])
)";

constexpr auto kAxisRead =
    R"(The axis of a file: points as .csv, an alignment of LandXML as .xml, others elements as text.

Parameters
----------
path : str or path-like
alignment : str, optional
    Its name, where a LandXML holds several.
cant_unit : float, optional
    Cant is in so many of the clouds' units; default 0.001 in LandXML, else 1.
gauge : float, optional
pivot : str, optional
    In place of the file's own; as `Axis` has them.
fit : float, optional
    For a file of points, as `Axis` has it.

Raises
------
FileError
    A ValueError and an OSError, naming the line or the distance.

Warns
-----
UserWarning
    The distance of the axis from the lines of the file.
)";

constexpr auto kAxisElements =
    R"(The axis that elements describe, a word and its numbers in each line.

Parameters
----------
text : str
    Lines such as `start X Y BEARING`, `straight LENGTH`, `arc LENGTH RADIUS`, `clothoid LENGTH FROM TO`, `chainage C`,
    `height C Z`, `cant C VALUE` and `equation C AHEAD`. Bearings are degrees clockwise from y; radii are positive to
    the right, and inf of a straight.

Examples
--------
>>> import pcl_bsh
>>> bend = pcl_bsh.Axis.elements("start 0 0 90\nstraight 40\nclothoid 30 inf 200\narc 50 200")
>>> bend.length, bend.smallest_radius
(120.0, 200.0)
)";

constexpr auto kFrame = R"(The axis' own frame at a distance along it, as a pose.

Returns
-------
ndarray of float64, (4, 4)
    Columns: along, to the left, up in the cant's plane; where offset and height are 0.
)";

using Pivot = As<"Literal['low_rail', 'centre']">;
using OptionalPivot = As<"Optional[Literal['low_rail', 'centre']]">;

CantPivot pivotOf(const py::object& pivot)
{
  const std::string text = py::str(pivot);
  if (const auto known = io::cantPivotOf(text)) return *known;
  throw InvalidInput(Input::pivot, "pivot", "`" + text + "` is unknown", "give \"low_rail\" or \"centre\"");
}

Axis axisThrough(const ArrayLike& points, const ArrayLike& chainages, const OptionalArray& cants, double gauge,
                 const Pivot& pivot, double most_turn, std::optional<double> fit)
{
  const std::vector<double> at = rowsOf("points", points, 3), chainage = rowsOf("chainages", chainages, 1);
  const std::size_t count = at.size() / 3;
  const std::vector<double> cant = cants.is_none() ? std::vector<double>(count, 0.0) : rowsOf("cants", cants, 1);
  for (const auto& [name, size] : {std::pair{"chainages", chainage.size()}, {"cants", cant.size()}})
    if (size != count)
      throw InvalidInput(Input::trajectory, name, "are " + std::to_string(size),
                         "give one for each of the " + counted(count, "point"));
  std::vector<AxisPoint> measured(count);
  for (std::size_t i = 0; i < count; ++i)
    measured[i] = {chainage[i], {at[3 * i], at[3 * i + 1], at[3 * i + 2]}, cant[i]};
  AxisDescription rest;
  rest.gauge = gauge;
  rest.pivot = pivotOf(pivot);
  return fit ? Axis::fitted(measured, *fit, rest, most_turn) : Axis::through(measured, rest, most_turn);
}

Axis axisOfFile(const PathLike& path, const std::optional<std::string>& alignment, std::optional<double> cant_unit,
                std::optional<double> gauge, const OptionalPivot& pivot, std::optional<double> fit)
{
  io::AxisSettings settings;
  settings.alignment = alignment.value_or("");
  settings.cant_unit = cant_unit;
  settings.gauge = gauge;
  settings.fit = fit;
  if (!pivot.is_none()) settings.pivot = pivotOf(pivot);
  const std::string file = pathOf(path);
  std::vector<std::string> remarks;
  Axis axis = unlocked([&] { return io::readAxis(file, settings, &remarks); });
  for (const std::string& remark : remarks) warn(file + ": " + remark);
  return axis;
}

Axis axisOfElements(const std::string& text)
{
  try {
    return Axis(io::parseElements(text));
  }
  catch (const io::FormatError& error) {
    throw InvalidInput(Input::trajectory, "elements", error.what(), error.remedy());
  }
}

/// @throws InvalidInput where the axis has no such distance
double onAxis(const Axis& axis, double distance)
{
  if (!(distance >= 0.0 && distance <= axis.length()))
    throw InvalidInput(Input::trajectory, "distance", numberText(distance) + " is not on the axis",
                       "give one from 0 to " + numberText(axis.length()))
        .withValue(distance);
  return distance;
}

py::array_t<double> frameOf(const Axis& axis, double distance)
{
  const AxisFrame frame = axis.frame(onAxis(axis, distance));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    pose.matrix().row(k) << frame.along[i], -frame.right[i], frame.up[i], frame.origin[i];
  }
  return arrayOf(pose);
}

} // namespace

void bindAxis(py::module_& module)
{
  py::class_<Axis>(module, "Axis", kAxis)
      .def(py::init(&axisThrough), "points"_a, "chainages"_a, "cants"_a = py::none(), py::kw_only(), "gauge"_a = 1.5,
           "pivot"_a = "low_rail", "most_turn"_a = 0.2, "fit"_a = py::none())
      .def_static("read", &axisOfFile, kAxisRead, "path"_a, py::kw_only(), "alignment"_a = py::none(),
                  "cant_unit"_a = py::none(), "gauge"_a = py::none(), "pivot"_a = py::none(), "fit"_a = py::none())
      .def_static("elements", &axisOfElements, kAxisElements, "text"_a)
      .def_property_readonly("length", &Axis::length, "In plan.")
      .def_property_readonly("smallest_radius", &Axis::smallestRadius, "inf of straights.")
      .def_property_readonly(
          "deviation", [](const Axis& axis) { return axis.fit().deviation; },
          "Through points: the farthest that it is from their polyline. Fitted: from a point.")
      .def(
          "chainage", [](const Axis& axis, double distance) { return axis.chainage(onAxis(axis, distance)); },
          "The number that a distance along the axis has.", "distance"_a)
      .def("distances_at", &Axis::distancesAt,
           "All distances with that chainage: none in a gap of the chainage, two where it repeats.", "chainage"_a)
      .def("frame", &frameOf, kFrame, "distance"_a)
      .def("__repr__", [](const Axis& axis) {
        return "Axis(chainage " + numberText(axis.chainage(0.0)) + " to " + numberText(axis.chainage(axis.length())) +
               ")";
      });
}

} // namespace pcl_bsh::python
