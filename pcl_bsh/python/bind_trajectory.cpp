// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/question/enclosed.h>

#include <pcl_bsh/trajectory/trajectory.h>

#include <pybind11/stl.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace pcl_bsh::python {
namespace {

/// A result, and what was asked for.
struct TrajectoryRun {
  TrajectoryRequest request;
  TrajectoryResult result;
};

constexpr auto kCollideAlong =
    R"(Which points of a scan does a model come near to along a path, how near, and when?

Parameters
----------
scan, model : SphereHierarchy
poses : array_like, (m, 4, 4) or (m, 3, 4)
    Poses of the model in the world: rigid transforms.
clearance : float, default 0
pose_scan : array_like, (4, 4) or (3, 4), optional
    Pose of the scan in the world.
flags, distances, first_poses, closest_poses, pose_summaries : bool
    Results to compute; arrays that are not asked for are None. `distances` and `closest_poses` measure each point that
    collides; one distance for each pose is told by `closest_pair_at_poses`, for less.
swept : float, optional
pivot : array_like, (3,), optional
    Swept: the point of the model that moves in straight lines; default its origin.
accuracy : Accuracy or str, default exact
solid, input_solid : bool, default False
    The model, or the scan, is a mesh that counts with what its faces enclose, and they must close: what is inside at a
    pose collides there. Its distance is less than 0: the depth at the pose where it is deepest.
threads : int, default 1
progress : callable, optional
    Called now and then with the fraction done; by returning False it stops the query, which raises `Cancelled`.

Returns
-------
Trajectory

See Also
--------
any_collision_at_poses : a verdict of each pose.
closest_pair_at_poses : the smallest distance at each pose, and its pair.

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

constexpr auto kPoseBetween = R"(The pose at a fraction in [0, 1] of the motion that `collide_along` calls swept.

Returns
-------
ndarray of float64, (4, 4)

Raises
------
ValueError
    Between poses that are half a turn apart: both directions are as short.
)";

TrajectoryRun collideAlongOf(const Cloud& scan, const Cloud& model, const ArrayLike& poses, double clearance,
                             const PoseLike& pose_scan, bool flags, bool distances, bool first_poses,
                             bool closest_poses, bool pose_summaries, std::optional<double> swept,
                             const OptionalArray& pivot, const AccuracyLike& accuracy, unsigned threads, bool solid,
                             bool input_solid, const ProgressLike& progress)
{
  PythonQuestion asked("scan", scan, pose_scan, "model", model);
  const auto& list = asked.question.path.emplace(posesOf("poses", poses));
  asked.question.clearance = clearance;
  asked.question.solid = solid;
  asked.question.input_solid = input_solid;
  asked.question.swept = swept.value_or(0.0);
  asked.question.threads = threads;
  asked.question.wanted.spacings = true;
  TrajectoryRun run;
  TrajectoryRequest& request = run.request;
  request.clearance = clearance;
  request.accuracy = accuracyOf(accuracy);
  request.flags = flags;
  request.distances = distances;
  request.first_poses = first_poses;
  request.closest_poses = closest_poses;
  request.pose_summaries = pose_summaries;
  if (swept != 0.0) request.swept = swept;
  if (!pivot.is_none()) request.pivot = point3Of("pivot", pivot);
  request.threads = threads;
  request.progress = progressOf(progress);
  const auto find = [&] {
    TrajectoryRequest wanted = request;
    wanted.flags = flags || solid || input_solid; // addEnclosed() counts by them
    TrajectoryResult found = collideAlong(asked.a, model, list, wanted);
    addEnclosed(asked.question, asked.input, asked.obstacle, found, request.pivot);
    return found;
  };
  run.result = asked.answer(find, [](const TrajectoryResult& found) { return nearestOf(found); });
  request.progress = nullptr; // it refers to an argument of this call
  return run;
}

py::array_t<double> poseBetweenOf(const ArrayLike& start, const ArrayLike& end, double fraction,
                                  const OptionalArray& pivot)
{
  const Point3 at = pivot.is_none() ? Point3{0, 0, 0} : point3Of("pivot", pivot);
  const Eigen::Isometry3d pose = poseBetween(poseOf("start", start), poseOf("end", end), fraction, at);
  return arrayOf(pose);
}

/// A property for one of the contacts.
auto contact(std::optional<FirstContact> TrajectoryResult::*of)
{
  return [of](const TrajectoryRun& run) -> std::optional<std::pair<std::size_t, double>> {
    const std::optional<FirstContact>& contact = run.result.*of;
    if (!contact) return std::nullopt;
    return std::pair(contact->pose, contact->fraction);
  };
}

/// A property for one of the result's vectors; None where, by `asked`, the request did not ask for it.
template <class T, class PythonQuestion>
auto columnWhere(std::vector<T> TrajectoryResult::*values, PythonQuestion asked)
{
  using Array = decltype(arrayIn(py::object(), std::vector<T>()));
  return [values, asked](const py::object& self) -> std::optional<Array> {
    const auto& run = self.cast<const TrajectoryRun&>();
    if (!std::invoke(asked, run.request)) return std::nullopt;
    return arrayIn(self, run.result.*values);
  };
}

constexpr auto kFindClashes =
    R"(Places where a path collides: clusters of colliding points, the most severe first.

Parameters
----------
scan : SphereHierarchy
    The scan that the path was asked about.
run : Trajectory
    The result of `collide_along` with flags, distances, first_poses and closest_poses.
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

constexpr auto kCompare = R"(Tells which clashes were there before.

Parameters
----------
clashes, earlier : list of Clash
nearness : float
    How near boxes must come to each other, per axis.

Returns
-------
list of Clash
    The clashes with `status` set and ids passed on, then those of `earlier` that are resolved.
)";

using Status = As<"Literal['new', 'persisting', 'resolved']">;

void bindClashes(py::module_& module)
{
  py::class_<Clash>(module, "Clash", "Colliding points of a scan that lie together. Coordinates are the scan's own.")
      .def_readonly("id", &Clash::id)
      .def_property_readonly(
          "status", [](const Clash& clash) { return Status(py::str(nameOf(clash.status))); },
          "'new', 'persisting' or 'resolved'.")
      .def_readonly("certain_points", &Clash::certain_points,
                    "Number of its points that collide wherever the points truly are; the others are undecided.")
      .def_property_readonly("records", column(&Clash::records), "int32: its rows, ascending; empty when resolved.")
      .def_readonly("points", &Clash::points)
      .def_readonly("low", &Clash::low, "The lower corner of its box.")
      .def_readonly("high", &Clash::high)
      .def_readonly("distance", &Clash::distance, "The smallest; less than 0 inside a solid: the greatest depth.")
      .def_property_readonly(
          "interval",
          [](const Clash& clash) -> std::optional<std::pair<double, double>> {
            if (std::isnan(clash.interval.lower)) return std::nullopt;
            return std::pair(clash.interval.lower, clash.interval.upper);
          },
          "Holds the distance for certain where a solid makes it less than 0, or may; else None.")
      .def_readonly("scan_point", &Clash::scan_point, "The rows that realise it.")
      .def_readonly("model_point", &Clash::model_point)
      .def_readonly("first_pose", &Clash::first_pose)
      .def_readonly("closest_pose", &Clash::closest_pose)
      .def("__repr__", [](const Clash& clash) {
        return "Clash('" + clash.id + "', " + nameOf(clash.status) + ", " + counted(clash.points, "point") +
               ", distance " + numberText(clash.distance) + ")";
      });
  module.def(
      "find_clashes",
      [](const Cloud& scan, const TrajectoryRun& run, double cluster_distance) {
        return unlocked([&] { return findClashes(scan.view(), run.result, cluster_distance); });
      },
      kFindClashes, "scan"_a, "run"_a, "cluster_distance"_a);
  module.def(
      "compare_with_earlier",
      [](std::vector<Clash> clashes, const std::vector<Clash>& earlier, double nearness) {
        compareWithEarlier(clashes, earlier, nearness);
        return clashes;
      },
      kCompare, "clashes"_a, "earlier"_a, "nearness"_a);
}

} // namespace

void bindTrajectory(py::module_& module)
{
  PYBIND11_NUMPY_DTYPE(PoseSummary, colliding, colliding_points, undecided_points, distance);

  using Request = TrajectoryRequest;
  const auto closest_point = [](const Request& r) { return r.distances || r.closest_poses; };
  using Result = TrajectoryResult;
  py::class_<TrajectoryRun>(module, "Trajectory",
                            "The answer of `collide_along`: an array has an entry for each record of the scan, and is "
                            "None unless it was asked for.")
      .def_property_readonly("flags", columnWhere(&Result::flags, &Request::flags), "uint8: a Verdict.")
      .def_property_readonly("distance", columnWhere(&Result::distance, &Request::distances),
                             "float32: the smallest over all poses, less radii; NaN where free. Less than 0 of what a "
                             "solid holds: the depth.")
      .def_property_readonly(
          "interval",
          [](const py::object& self) -> std::optional<py::array_t<double>> {
            const auto& interval = self.cast<const TrajectoryRun&>().result.interval;
            if (interval.empty()) return std::nullopt;
            return arrayIn(self, &interval.front().lower, {static_cast<py::ssize_t>(interval.size()), 2});
          },
          "(records, 2) float64, with distances, where a solid holds anything: holds the distance of a record for "
          "certain that it makes less than 0, or may; NaN of others. Else None.")
      .def_property_readonly("first_pose", columnWhere(&Result::first_pose, &Request::first_poses),
                             "int32; -1 where free.")
      .def_property_readonly("closest_pose", columnWhere(&Result::closest_pose, &Request::closest_poses),
                             "int32; -1 where free.")
      .def_property_readonly("closest_point", columnWhere(&Result::closest_point, closest_point),
                             "int32: the row of the model; -1 where free.")
      .def_property_readonly(
          "certain_pose",
          [](const py::object& self) -> std::optional<py::array_t<std::int32_t>> {
            const auto& run = self.cast<const TrajectoryRun&>();
            if (run.result.certain_pose.empty()) return std::nullopt;
            return arrayIn(self, run.result.certain_pose);
          },
          "int32, with first_poses, where points are uncertain: the first pose at which a point collides for certain.")
      .def_property_readonly("poses", columnWhere(&Result::poses, &Request::pose_summaries),
                             "For each pose colliding, colliding_points, undecided_points, distance.")
      .def_property_readonly("colliding", [](const TrajectoryRun& run) { return run.result.colliding; })
      .def_property_readonly("undecided", [](const TrajectoryRun& run) { return run.result.undecided; })
      .def_property_readonly("first_contact", contact(&Result::first_contact),
                             "Swept: (pose, fraction of the motion to the next); None when free.")
      .def_property_readonly("certain_contact", contact(&Result::certain_contact),
                             "The first contact of points that collide for certain, where points are uncertain.")
      .def_property_readonly("work", [](const TrajectoryRun& run) { return run.result.work; })
      .def("__repr__", [](const TrajectoryRun& run) {
        return "Trajectory(" + counted(run.result.colliding, "point") + " collide" +
               (run.result.undecided ? ", " + std::to_string(run.result.undecided) + " are undecided" : "") + ")";
      });
  module.def("collide_along", &collideAlongOf, kCollideAlong, "scan"_a, "model"_a, "poses"_a, "clearance"_a = 0.0,
             py::kw_only(), "pose_scan"_a = py::none(), "flags"_a = true, "distances"_a = false,
             "first_poses"_a = false, "closest_poses"_a = false, "pose_summaries"_a = false, "swept"_a = py::none(),
             "pivot"_a = py::none(), "accuracy"_a = py::none(), "threads"_a = 1, "solid"_a = false,
             "input_solid"_a = false, "progress"_a = py::none());
  module.def("pose_between", &poseBetweenOf, kPoseBetween, "start"_a, "end"_a, "fraction"_a, "pivot"_a = py::none());
  bindClashes(module);
}

} // namespace pcl_bsh::python
