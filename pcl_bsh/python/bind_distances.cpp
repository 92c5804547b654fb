// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>

#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

namespace pcl_bsh::python {
namespace {

constexpr auto kPointDistances =
    R"(How far each point of a is from b, and from which of its points.

Parameters
----------
a, b : SphereHierarchy
max_distance : float, optional
pose_a, pose_b : array_like, (4, 4) or (3, 4), optional
    Rigid transforms from the cloud to the world.
accuracy : Accuracy or str, default exact
    A tolerance, or a budget: then `interval` has what is certain of each point.
threads : int, default 1
**options of distances
progress : callable, optional
    Called now and then with the fraction done; by returning False it stops the query, which raises `Cancelled`.

Returns
-------
PointDistances
    Unpacks as ``distance, closest_point``. `distance` (records of a,) is float64, NaN where no record is within reach;
    `closest_point` is int32: its row in b, of several the smallest, -1 where no record is within reach.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0], [9, 0, 0]]))
>>> b = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 7], [0, 0, 2]]))
>>> distance, closest_point = pcl_bsh.point_distances(a, b, max_distance=5.0)
>>> distance
array([ 2., nan])
>>> closest_point
array([ 1, -1], dtype=int32)
)";

constexpr auto kSymmetricDistances =
    R"(Distances in both directions, and the Hausdorff distance.

Parameters
----------
input_solid : bool, optional
All others are those of `point_distances`.

Returns
-------
SymmetricDistances
    `a` and `b` are `PointDistances`, of meshes from each triangle's nearest place. `hausdorff` is the greatest distance of
    all places, of meshes of those inside triangles, too; `hausdorff_interval` (lower, upper) holds it for certain, no
    wider than the accuracy's tolerance, or than 2^-14 of the larger box's diagonal. NaN where a record has no distance.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0]]))
>>> b = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 1], [0, 0, 2]]))
>>> both = pcl_bsh.symmetric_distances(a, b)
>>> both.hausdorff, both.hausdorff_pair
(2.0, (0, 1))
)";

constexpr auto kHausdorffDistance =
    R"(The symmetric Hausdorff distance, without measuring every point: that of `symmetric_distances`, bit for bit, for less.
For meshes, it is the distance of all places of their triangles, as an interval.

Parameters
----------
a, b : SphereHierarchy
    Meshes count as surfaces: `solid` is for `symmetric_distances`.
pose_a, pose_b, threads, progress
    As of `point_distances`.
accuracy : Accuracy or str, optional
    Exact, or ``tolerance=LENGTH``: how wide the interval of meshes may be; exact: 2^-14 of the larger box's diagonal.

Returns
-------
HausdorffDistance
    Unpacks as ``distance, pair``. `distance` is the greatest distance from a place of either cloud to the other cloud,
    NaN where a cloud is empty: of points exactly, of meshes that of the farthest place that was measured. `interval`
    (lower, upper) holds it for certain. `pair` realises it, of points the smallest (a, b), or is None.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 0]]))
>>> b = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 1], [0, 0, 2]]))
>>> distance, pair = pcl_bsh.hausdorff_distance(a, b)
>>> distance, pair
(2.0, (0, 1))
)";

template <bool both_ways>
auto distancesOf(const Cloud& a, const Cloud& b, std::optional<double> max_distance, const PoseLike& pose_a,
                 const PoseLike& pose_b, const AccuracyLike& accuracy, unsigned threads, const ProgressLike& progress,
                 const py::kwargs& options)
{
  PythonQuestion asked(a, pose_a, b, pose_b);
  Question& question = asked.question;
  question.max_distance = max_distance;
  question.accuracy = accuracyOf(accuracy);
  question.threads = threads;
  asked.set(options, both_ways ? QuestionKind::both_ways : QuestionKind::distances);
  question.progress = progressOf(progress);
  question.wanted.distances = question.wanted.intervals = true;
  question.wanted.both_ways = both_ways;
  SymmetricDistances found = asked.answer().distances;
  if constexpr (both_ways)
    return found;
  else
    return std::move(found.a);
}

HausdorffDistance hausdorffDistanceOf(const Cloud& a, const Cloud& b, const PoseLike& pose_a, const PoseLike& pose_b,
                                      const AccuracyLike& accuracy, unsigned threads, const ProgressLike& progress)
{
  PythonQuestion asked(a, pose_a, b, pose_b);
  const HausdorffRequest request{accuracyOf(accuracy), threads, progressOf(progress)};
  return asked.answer([&] { return hausdorffDistance(asked.a, asked.b, request); },
                      [](const HausdorffDistance&) { return 0.0; }); // 0: no warning about hollow surfaces
}

std::optional<py::array_t<double>> intervalArray(const py::object& self)
{
  static_assert(sizeof(Interval) == 2 * sizeof(double));
  const auto& interval = self.cast<const PointDistances&>().interval;
  if (interval.empty()) return std::nullopt;
  return arrayIn(self, &interval.front().lower, {static_cast<py::ssize_t>(interval.size()), 2});
}

} // namespace

void bindDistances(py::module_& module)
{
  py::class_<PointDistances>(module, "PointDistances",
                             "The answer of `point_distances`; unpacks as distance, closest_point.")
      .def_property_readonly("distance", column(&PointDistances::distance), "(records,) float64; NaN: none.")
      .def_property_readonly("closest_point", column(&PointDistances::closest_point), "(records,) int32; -1: none.")
      .def_property_readonly("interval", &intervalArray,
                             "(records, 2) float64: holds each distance for certain, where the accuracy is less than "
                             "exact, or a solid holds triangles; else None.")
      .def_readonly("measured", &PointDistances::measured, "Points that have a distance.")
      .def_readonly("undecided", &PointDistances::undecided, "Points that were left when the search stopped.")
      .def_readonly("greatest", &PointDistances::greatest, "The greatest of all distances; NaN without distances.")
      .def_property_readonly("greatest_pair", [](const PointDistances& found) { return tupleOf(found.greatest_pair); })
      .def_readonly("work", &PointDistances::work)
      .def("__len__", [](const PointDistances&) { return 2; })
      .def("__iter__",
           [](const py::object& self) {
             return py::iter(py::make_tuple(self.attr("distance"), self.attr("closest_point")));
           })
      .def("__repr__", [](const PointDistances& found) {
        return "PointDistances(" + std::to_string(found.measured) + " of " + std::to_string(found.distance.size()) +
               " measured" + (found.undecided ? ", " + std::to_string(found.undecided) + " undecided" : "") + ")";
      });
  py::class_<SymmetricDistances>(module, "SymmetricDistances", "The answer of `symmetric_distances`.")
      .def_readonly("a", &SymmetricDistances::a, "From each point of a to b.")
      .def_readonly("b", &SymmetricDistances::b, "From each point of b to a.")
      .def_readonly("hausdorff", &SymmetricDistances::hausdorff)
      .def_property_readonly(
          "hausdorff_interval",
          [](const SymmetricDistances& found) {
            return py::make_tuple(found.hausdorff_interval.lower, found.hausdorff_interval.upper);
          },
          "(lower, upper): holds the Hausdorff distance for certain.")
      .def_property_readonly("hausdorff_pair",
                             [](const SymmetricDistances& found) { return tupleOf(found.hausdorff_pair); })
      .def("__repr__", [](const SymmetricDistances& found) {
        return "SymmetricDistances(hausdorff=" + numberText(found.hausdorff) + ")";
      });
  py::class_<HausdorffDistance>(module, "HausdorffDistance",
                                "The answer of `hausdorff_distance`; unpacks as distance, pair.")
      .def_readonly("distance", &HausdorffDistance::distance)
      .def_property_readonly(
          "interval",
          [](const HausdorffDistance& found) { return py::make_tuple(found.interval.lower, found.interval.upper); },
          "(lower, upper): holds the distance for certain.")
      .def_property_readonly("pair", [](const HausdorffDistance& found) { return tupleOf(found.pair); })
      .def_readonly("work", &HausdorffDistance::work)
      .def("__len__", [](const HausdorffDistance&) { return 2; })
      .def("__iter__",
           [](const HausdorffDistance& found) { return py::iter(py::make_tuple(found.distance, tupleOf(found.pair))); })
      .def("__repr__",
           [](const HausdorffDistance& found) { return "HausdorffDistance(" + numberText(found.distance) + ")"; });
  module.def("hausdorff_distance", &hausdorffDistanceOf, kHausdorffDistance, "a"_a, "b"_a, py::kw_only(),
             "pose_a"_a = py::none(), "pose_b"_a = py::none(), "accuracy"_a = py::none(), "threads"_a = 1,
             "progress"_a = py::none());
  const auto define = [&](const char* name, auto function, const char* text) {
    module.def(name, function, text, "a"_a, "b"_a, "max_distance"_a = py::none(), py::kw_only(),
               "pose_a"_a = py::none(), "pose_b"_a = py::none(), "accuracy"_a = py::none(), "threads"_a = 1,
               "progress"_a = py::none());
  };
  define("point_distances", &distancesOf<false>, kPointDistances);
  define("symmetric_distances", &distancesOf<true>, kSymmetricDistances);
}

} // namespace pcl_bsh::python
