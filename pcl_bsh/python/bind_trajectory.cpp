// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/python/arrays/array_input.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/callback.h>
#include <pcl_bsh/python/question_warnings.h>
#include <pcl_bsh/python/trajectory_run.h>

#include <pybind11/stl.h>

#include <optional>
#include <string>

namespace pcl_bsh::python {
namespace {

constexpr auto kCollideAlong =
    R"(collide_along(scan, model, poses, clearance=0.0, *, pose_scan=None, flags=True, distances=False, first_poses=False, closest_poses=False, pose_summaries=False, swept=None, pivot=None, accuracy=None, threads=1, progress=None)
--

Which points of a scan does a model come near to along a path, how near, and when?

Parameters
----------
scan, model : SphereHierarchy
poses : array_like, (m, 4, 4) or (m, 3, 4)
    Of the model in the world: rigid transforms.
clearance : float, default 0
    In the clouds' unit; inclusive.
pose_scan : array_like, (4, 4) or (3, 4), optional
    Of the scan in the world.
flags, distances, first_poses, closest_poses, pose_summaries : bool
    What to compute; arrays that are not asked for are None.
swept : float, optional
    The motion between poses counts, too, to this tolerance: free is farther than the clearance during the whole motion,
    colliding comes within clearance + swept.
pivot : array_like, (3,), optional
    Swept: the point of the model that moves in straight lines; default its origin.
accuracy : Accuracy or str, default exact
threads : int, default 1
    0: all of the machine's.
progress : callable, optional
    Called now and then with the fraction done; by returning False it stops the query, which raises `Cancelled`.

Returns
-------
Trajectory

Raises
------
ValueError
    Naming the value that is wrong, a pose by its index.
Cancelled
KeyboardInterrupt
    On Ctrl-C, while it computes.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> wall = pcl_bsh.SphereHierarchy(np.array([[x, 0.0, 1.0] for x in range(5)]))
>>> wagon = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
>>> poses = np.tile(np.eye(4), (3, 1, 1)); poses[:, 0, 3] = [0, 1, 2]
>>> run = pcl_bsh.collide_along(wall, wagon, poses, clearance=1.0, first_poses=True, distances=True)
>>> run.flags
array([1, 1, 1, 0, 0], dtype=uint8)
>>> run.first_pose
array([ 0,  1,  2, -1, -1], dtype=int32)
>>> run.distance
array([ 1.,  1.,  1., nan, nan], dtype=float32)
)";

constexpr auto kPoseBetween = R"(pose_between(start, end, fraction, pivot=None)
--

The pose at a fraction in [0, 1] of the motion that `collide_along` calls swept.

Returns
-------
ndarray of float64, (4, 4)

Raises
------
ValueError
    Between poses that are half a turn apart: both directions are as short.
)";

TrajectoryRun collideAlongOf(const SphereHierarchy& scan, const SphereHierarchy& model, const py::object& poses,
                             double clearance, const py::object& pose_scan, bool flags, bool distances,
                             bool first_poses, bool closest_poses, bool pose_summaries, std::optional<double> swept,
                             const py::object& pivot, const py::object& accuracy, unsigned threads,
                             const py::object& progress)
{
  const Placed placed(scan, poseOf("pose_scan", pose_scan));
  const std::vector<Eigen::Isometry3d> list = posesOf("poses", poses);
  TrajectoryRun run;
  TrajectoryRequest& request = run.request;
  request.clearance = clearance;
  request.accuracy = accuracyOf(accuracy);
  request.flags = flags;
  request.distances = distances;
  request.first_poses = first_poses;
  request.closest_poses = closest_poses;
  request.pose_summaries = pose_summaries;
  request.swept = swept;
  if (!pivot.is_none()) request.pivot = point3Of("pivot", pivot);
  request.threads = threads;
  request.progress = progressOf(progress);
  run.result = answered({"scan", placed, "model", model, list, clearance, true},
                        [&] { return collideAlong(placed, model, list, request); });
  request.progress = nullptr; // it refers to an argument of this call
  return run;
}

py::array poseBetweenOf(const py::object& start, const py::object& end, double fraction, const py::object& pivot)
{
  const Point3 at = pivot.is_none() ? Point3{0, 0, 0} : point3Of("pivot", pivot);
  const Eigen::Isometry3d pose = poseBetween(poseOf("start", start), poseOf("end", end), fraction, at);
  return arrayOf(pose);
}

py::object contactOf(const std::optional<FirstContact>& contact)
{
  if (!contact) return py::none();
  return py::make_tuple(contact->pose, contact->fraction);
}

/// A property for one of the result's vectors.
template <class T>
auto column(std::vector<T> TrajectoryResult::*values, bool (*asked)(const TrajectoryRequest&))
{
  return [values, asked](const py::object& self) {
    const auto& run = self.cast<const TrajectoryRun&>();
    return arrayInOrNone(self, run.result.*values, asked(run.request));
  };
}

} // namespace

void bindTrajectory(py::module_& module)
{
  PYBIND11_NUMPY_DTYPE(PoseSummary, colliding, colliding_points, undecided_points, distance);

  using Request = TrajectoryRequest;
  const auto flags = [](const Request& r) { return r.flags; };
  const auto distances = [](const Request& r) { return r.distances; };
  const auto first = [](const Request& r) { return r.first_poses; };
  const auto closest = [](const Request& r) { return r.closest_poses; };
  const auto closest_point = [](const Request& r) { return r.distances || r.closest_poses; };
  const auto summaries = [](const Request& r) { return r.pose_summaries; };
  using Result = TrajectoryResult;
  py::class_<TrajectoryRun>(module, "Trajectory",
                            "The answer of `collide_along`: an array has an entry for each record of the scan, and is "
                            "None unless it was asked for.")
      .def_property_readonly("flags", column(&Result::flags, flags), "uint8: a Verdict.")
      .def_property_readonly("distance", column(&Result::distance, distances),
                             "float32: the smallest over all poses, less radii; NaN where free.")
      .def_property_readonly("first_pose", column(&Result::first_pose, first), "int32; -1 where free.")
      .def_property_readonly("closest_pose", column(&Result::closest_pose, closest), "int32; -1 where free.")
      .def_property_readonly("closest_point", column(&Result::closest_point, closest_point),
                             "uint32: the row of the model; NO_POINT where free.")
      .def_property_readonly(
          "certain_pose",
          [](const py::object& self) {
            const auto& run = self.cast<const TrajectoryRun&>();
            return arrayInOrNone(self, run.result.certain_pose, !run.result.certain_pose.empty());
          },
          "int32, with first_poses, where points are uncertain: the first pose at which a point collides for certain.")
      .def_property_readonly("poses", column(&Result::poses, summaries),
                             "For each pose colliding, colliding_points, undecided_points, distance.")
      .def_property_readonly("colliding", [](const TrajectoryRun& run) { return run.result.colliding; })
      .def_property_readonly("undecided", [](const TrajectoryRun& run) { return run.result.undecided; })
      .def_property_readonly(
          "first_contact", [](const TrajectoryRun& run) { return contactOf(run.result.first_contact); },
          "Swept: (pose, fraction of the motion to the next); None when free.")
      .def_property_readonly(
          "certain_contact", [](const TrajectoryRun& run) { return contactOf(run.result.certain_contact); },
          "The same of what collides for certain, where points are uncertain.")
      .def_property_readonly("work", [](const TrajectoryRun& run) { return run.result.work; })
      .def("__repr__", [](const TrajectoryRun& run) {
        return "Trajectory(" + counted(run.result.colliding, "point") + " collide" +
               (run.result.undecided ? ", " + std::to_string(run.result.undecided) + " are undecided" : "") + ")";
      });
  module.def("collide_along", &collideAlongOf, kCollideAlong, py::arg("scan"), py::arg("model"), py::arg("poses"),
             py::arg("clearance") = 0.0, py::kw_only(), py::arg("pose_scan") = py::none(), py::arg("flags") = true,
             py::arg("distances") = false, py::arg("first_poses") = false, py::arg("closest_poses") = false,
             py::arg("pose_summaries") = false, py::arg("swept") = py::none(), py::arg("pivot") = py::none(),
             py::arg("accuracy") = py::none(), py::arg("threads") = 1, py::arg("progress") = py::none());
  module.def("pose_between", &poseBetweenOf, kPoseBetween, py::arg("start"), py::arg("end"), py::arg("fraction"),
             py::arg("pivot") = py::none());
}

} // namespace pcl_bsh::python
