// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/callback.h>
#include <pcl_bsh/python/trajectory_run.h>

#include <pybind11/stl.h>

#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kFindClashes = R"(find_clashes(scan, run, cluster_distance)
--

What collides along a path, place by place: clusters of colliding points, the most severe first.

Parameters
----------
scan : SphereHierarchy
    That the path was asked about.
run : Trajectory
    Of `collide_along` with flags, distances, first_poses and closest_poses.
cluster_distance : float
    Points no farther apart belong together; > 0.

Returns
-------
list of Clash
    With ids that tell the place, the same in every run in which the clash stays there.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> scan = pcl_bsh.SphereHierarchy(np.array([[0.0, 0, 1], [0.1, 0, 1], [5, 0, 1]]))
>>> model = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
>>> poses = np.tile(np.eye(4), (2, 1, 1)); poses[1, 0, 3] = 5
>>> run = pcl_bsh.collide_along(scan, model, poses, 1.1, distances=True, first_poses=True, closest_poses=True)
>>> [(clash.points, clash.distance, clash.first_pose) for clash in pcl_bsh.find_clashes(scan, run, 0.5)]
[(2, 1.0, 0), (1, 1.0, 1)]
)";

constexpr auto kCompare = R"(compare_with_earlier(clashes, earlier, nearness)
--

Tells which clashes were there before.

Parameters
----------
clashes, earlier : list of Clash
nearness : float
    How near boxes must come to each other, per axis.

Returns
-------
list of Clash
    The same with `status` set and ids passed on, and after them those of `earlier` that are resolved.
)";

} // namespace

void bindClashes(py::module_& module)
{
  py::class_<Clash>(module, "Clash", "Colliding points of a scan that lie together. Coordinates are the scan's own.")
      .def_readonly("id", &Clash::id)
      .def_property_readonly(
          "status", [](const Clash& clash) { return nameOf(clash.status); }, "'new', 'persisting' or 'resolved'.")
      .def_readonly("certain_points", &Clash::certain_points,
                    "Of its points, how many collide wherever the points truly are; the others are undecided.")
      .def_property_readonly(
          "records", [](const py::object& self) { return arrayIn(self, self.cast<const Clash&>().records); },
          "uint32: its rows, ascending; empty when resolved.")
      .def_readonly("points", &Clash::points)
      .def_readonly("low", &Clash::low, "The lower corner of its box.")
      .def_readonly("high", &Clash::high)
      .def_readonly("distance", &Clash::distance, "The smallest.")
      .def_readonly("scan_point", &Clash::scan_point, "The rows that realise it.")
      .def_readonly("model_point", &Clash::model_point)
      .def_readonly("first_pose", &Clash::first_pose)
      .def_readonly("closest_pose", &Clash::closest_pose)
      .def("__repr__", [](const Clash& clash) {
        return "Clash('" + clash.id + "', " + nameOf(clash.status) + ", " + counted(clash.points, "point") +
               ", distance " + std::string(py::str(py::float_(clash.distance))) + ")";
      });
  module.def(
      "find_clashes",
      [](const SphereHierarchy& scan, const TrajectoryRun& run, double cluster_distance) {
        return unlocked([&] { return findClashes(scan.view(), run.result, cluster_distance); });
      },
      kFindClashes, py::arg("scan"), py::arg("run"), py::arg("cluster_distance"));
  module.def(
      "compare_with_earlier",
      [](std::vector<Clash> clashes, const std::vector<Clash>& earlier, double nearness) {
        compareWithEarlier(clashes, earlier, nearness);
        return clashes;
      },
      kCompare, py::arg("clashes"), py::arg("earlier"), py::arg("nearness"));
}

} // namespace pcl_bsh::python
