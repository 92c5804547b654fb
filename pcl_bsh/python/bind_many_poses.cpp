// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/python/arrays/array_output.h>
#include <pcl_bsh/python/bindings.h>
#include <pcl_bsh/python/python_question.h>
#include <pcl_bsh/question/enclosed.h>

#include <utility>

namespace pcl_bsh::python {
namespace {

constexpr auto kAnyAtPoses =
    R"(Does any pair of points collide, b at each of many poses?

Parameters
----------
a, b : SphereHierarchy
poses : array_like, (m, 4, 4) or (m, 3, 4)
    Poses of b in the world.
clearance : float, default 0
pose_a : array_like, (4, 4) or (3, 4), optional
accuracy : Accuracy or str, default exact
    None that stops early.
threads : int, default 1
solid, input_solid : bool, default False
    b, or a, is a mesh that counts with what its faces enclose: what is inside collides.
progress : callable, optional
    Called now and then with the fraction done; False stops the query, which raises `Cancelled`.

Returns
-------
ndarray of uint8, (m,)
    1 where colliding, 0 where free: a `Verdict`.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a, b = pcl_bsh.SphereHierarchy(np.zeros((1, 3))), pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
>>> poses = np.tile(np.eye(4), (3, 1, 1)); poses[:, 0, 3] = [0, 1, 2]
>>> pcl_bsh.any_collision_at_poses(a, b, poses, clearance=1.0)
array([1, 1, 0], dtype=uint8)
)";

constexpr auto kClosestAtPoses = R"(The smallest distance, b at each of many poses.

Parameters are those of `any_collision_at_poses`, except `clearance` and `accuracy`.

Returns
-------
distances : ndarray of float64, (m,)
    Negative where a solid encloses a record: the depth of the deepest.
pairs : ndarray of int32, (m, 2)
    Rows of a and b; -1 when a cloud is empty.

See Also
--------
collide_along : of each point that collides, its smallest distance over all poses.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> a, b = pcl_bsh.SphereHierarchy(np.zeros((1, 3))), pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
>>> poses = np.tile(np.eye(4), (3, 1, 1)); poses[:, 0, 3] = [0, 1, 2]
>>> pcl_bsh.closest_pair_at_poses(a, b, poses)[0]
array([0., 1., 2.])
)";

constexpr auto kOnMotions =
    R"(Does any pair of points collide on each of many motions: the edges of a planner's roadmap.

Parameters
----------
scan, model : SphereHierarchy
poses : array_like, (m, 4, 4) or (m, 3, 4)
    Poses of the model in the world: vertices that motions share.
motions : array_like of int, (k, 2)
    From one pose of the list to another.
clearance : float, default 0
swept : float
    Free is farther than the clearance at every instant, colliding comes within clearance + `swept`; > 0.
pose_scan : array_like, (4, 4) or (3, 4), optional
pivot : array_like, (3,), optional
    The point of the model that moves in straight lines; default its origin.
threads : int, default 1
solid, input_solid : bool, default False
    The model, or the scan, is a mesh that counts with what its faces enclose: what is inside collides.
progress : callable, optional

Returns
-------
ndarray of uint8, (k,)
    1 where colliding, 0 where free.

Examples
--------
>>> import numpy as np, pcl_bsh
>>> wall = pcl_bsh.SphereHierarchy(np.array([[5.0, 0, 0]]))
>>> drone = pcl_bsh.SphereHierarchy(np.zeros((1, 3)))
>>> poses = np.tile(np.eye(4), (3, 1, 1)); poses[:, 0, 3] = [0, 4, 9]
>>> pcl_bsh.any_collision_on_motions(wall, drone, poses, [[0, 1], [1, 2]], 0.5, swept=0.01)
array([0, 1], dtype=uint8)
)";

py::array_t<std::uint8_t> anyAtPosesOf(const Cloud& a, const Cloud& b, const ArrayLike& poses, double clearance,
                                       const PoseLike& pose_a, const AccuracyLike& accuracy, unsigned threads,
                                       bool solid, bool input_solid, const ProgressLike& progress)
{
  PythonQuestion asked("a", a, pose_a, "b", b);
  asked.question.solid = solid;
  asked.question.input_solid = input_solid;
  const auto& list = asked.question.path.emplace(posesOf("poses", poses));
  AnyRequest request;
  asked.question.clearance = request.clearance = clearance;
  request.accuracy = accuracyOf(accuracy);
  request.threads = threads;
  request.progress = progressOf(progress);
  const auto find = [&] {
    AnyAtPoses of_surfaces = anyCollisionAtPoses(asked.a, b, list, request);
    addEnclosed(asked.question, asked.input, asked.obstacle, list, of_surfaces.flags);
    return of_surfaces;
  };
  return arrayFrom(asked.answer(find, [](const AnyAtPoses& found) { return nearestOf(found.flags); }).flags);
}

std::pair<py::array_t<double>, py::array_t<std::int32_t>>
closestAtPosesOf(const Cloud& a, const Cloud& b, const ArrayLike& poses, const PoseLike& pose_a, unsigned threads,
                 bool solid, bool input_solid, const ProgressLike& progress)
{
  PythonQuestion asked("a", a, pose_a, "b", b);
  asked.question.solid = solid;
  asked.question.input_solid = input_solid;
  const auto& list = asked.question.path.emplace(posesOf("poses", poses));
  const DistanceRequest request(threads, progressOf(progress));
  const auto find = [&] {
    DistancesAtPoses of_surfaces = closestPairAtPoses(asked.a, b, list, request);
    addEnclosed(asked.question, asked.input, asked.obstacle, list, of_surfaces.distances, of_surfaces.pairs);
    return of_surfaces;
  };
  DistancesAtPoses found = asked.answer(find, [](const DistancesAtPoses& all) { return nearestOf(all.distances); });
  found.pairs.resize(list.size(), {kNothing, kNothing});
  return {arrayFrom(std::move(found.distances)), arrayFrom(found.pairs)};
}

py::array_t<std::uint8_t> onMotionsOf(const Cloud& scan, const Cloud& model, const ArrayLike& poses,
                                      const ArrayLike& motions, double clearance, double swept,
                                      const PoseLike& pose_scan, const OptionalArray& pivot, unsigned threads,
                                      bool solid, bool input_solid, const ProgressLike& progress)
{
  PythonQuestion asked("scan", scan, pose_scan, "model", model);
  asked.question.solid = solid;
  asked.question.input_solid = input_solid;
  const auto& list = asked.question.path.emplace(posesOf("poses", poses));
  const std::vector<std::uint32_t> ends = recordsOf("motions", motions, 2);
  std::vector<PoseMotion> edges;
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) edges.push_back({ends[i], ends[i + 1]});
  MotionsRequest request;
  asked.question.clearance = request.clearance = clearance;
  request.swept = swept;
  if (!pivot.is_none()) request.pivot = point3Of("pivot", pivot);
  request.threads = threads;
  request.progress = progressOf(progress);
  const auto find = [&] {
    AnyOnMotions of_surfaces = anyCollisionOnMotions(asked.a, model, list, edges, request);
    std::vector<Eigen::Isometry3d> starts;
    for (const PoseMotion& edge : edges) starts.push_back(list[edge.from]);
    addEnclosed(asked.question, asked.input, asked.obstacle, starts, of_surfaces.flags);
    return of_surfaces;
  };
  return arrayFrom(asked.answer(find, [](const AnyOnMotions& found) { return nearestOf(found.flags); }).flags);
}

} // namespace

void bindManyPoses(py::module_& module)
{
  module.def("any_collision_at_poses", &anyAtPosesOf, kAnyAtPoses, "a"_a, "b"_a, "poses"_a, "clearance"_a = 0.0,
             py::kw_only(), "pose_a"_a = py::none(), "accuracy"_a = py::none(), "threads"_a = 1, "solid"_a = false,
             "input_solid"_a = false, "progress"_a = py::none());
  module.def("closest_pair_at_poses", &closestAtPosesOf, kClosestAtPoses, "a"_a, "b"_a, "poses"_a, py::kw_only(),
             "pose_a"_a = py::none(), "threads"_a = 1, "solid"_a = false, "input_solid"_a = false,
             "progress"_a = py::none());
  module.def("any_collision_on_motions", &onMotionsOf, kOnMotions, "scan"_a, "model"_a, "poses"_a, "motions"_a,
             "clearance"_a = 0.0, py::kw_only(), "swept"_a, "pose_scan"_a = py::none(), "pivot"_a = py::none(),
             "threads"_a = 1, "solid"_a = false, "input_solid"_a = false, "progress"_a = py::none());
}

} // namespace pcl_bsh::python
