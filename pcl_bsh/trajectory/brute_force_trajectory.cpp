// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/query/brute_force_points.h>
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/trajectory/check_trajectory.h>
#include <pcl_bsh/trajectory/trajectory.h>

namespace pcl_bsh::brute_force {
namespace {

/// The smallest distance that a point, or a pose, has seen so far.
struct Closest {
  const RecordDistance* distance = nullptr;
  PointPair pair;
  std::size_t pose = 0;

  void consider(const RecordDistance& at, std::size_t k, PointPair other)
  {
    if (distance && at.compareGaps(other, *distance, pair) >= 0) return;
    *this = {&at, other, k};
  }
};

} // namespace

TrajectoryResult collideAlong(const Placed& scan, const SphereHierarchy& model,
                              const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request)
{
  check(scan, model_poses, request);
  if (request.swept)
    throw InvalidInput(Input::swept, "brute_force::collideAlong", "knows poses only, not what is between");
  const DefaultFloatEnvironment environment;
  const std::vector<FinitePoint> points = finitePoints(scan.hierarchy().view()), obstacles = finitePoints(model.view());
  std::vector<RecordDistance> distances;
  distances.reserve(model_poses.size());
  for (const Eigen::Isometry3d& pose : model_poses)
    distances.emplace_back(scan.hierarchy().view(), scan.pose, model.view(), pose);

  if (!asksForAnything(request)) return {};
  TrajectoryResult result = allFree(request, scan.hierarchy().view().count, model_poses.size());
  const bool uncertain = areUncertain(scan, {model});
  if (uncertain) result.certain_pose = result.first_pose;
  const auto reachAt = [&](MeantPlaces places) {
    return PairReach(scan.hierarchy().view(), model.view(), request.clearance, places);
  };
  const PairReach possible = reachAt(uncertain ? MeantPlaces::possible : MeantPlaces::measured);
  const PairReach surely = reachAt(uncertain ? MeantPlaces::certain : MeantPlaces::measured);
  std::vector<Closest> of_poses(model_poses.size());
  for (const FinitePoint& p : points) {
    Closest of_point;
    std::int32_t first = -1, certain = -1;
    for (std::size_t k = 0; k < distances.size(); ++k) {
      Verdict verdict = Verdict::free;
      for (const FinitePoint& q : obstacles) {
        ++result.work.exact_decisions;
        const PointPair pair{p.record, q.record};
        if (!possible.holds(distances[k], pair)) continue;
        const bool collides = !uncertain || surely.holds(distances[k], pair);
        if (collides || verdict == Verdict::free) verdict = collides ? Verdict::colliding : Verdict::undecided;
        of_point.consider(distances[k], k, pair);
        of_poses[k].consider(distances[k], k, pair);
      }
      if (verdict == Verdict::free) continue;
      const bool collides = verdict == Verdict::colliding;
      if (first < 0) first = static_cast<std::int32_t>(k);
      if (collides && certain < 0) certain = static_cast<std::int32_t>(k);
      if (!request.pose_summaries) continue;
      ++(collides ? result.poses[k].colliding_points : result.poses[k].undecided_points);
    }
    if (first < 0) continue;
    ++(certain < 0 ? result.undecided : result.colliding);
    if (request.flags) result.flags[p.record] = certain < 0 ? Verdict::undecided : Verdict::colliding;
    if (request.first_poses && uncertain) result.certain_pose[p.record] = certain;
    if (request.first_poses) result.first_pose[p.record] = first;
    if (request.distances) result.distance[p.record] = static_cast<float>(of_point.distance->gap(of_point.pair));
    if (request.closest_poses) result.closest_pose[p.record] = static_cast<std::int32_t>(of_point.pose);
    if (!result.closest_point.empty()) result.closest_point[p.record] = of_point.pair.b;
  }
  for (std::size_t k = 0; k < result.poses.size(); ++k) {
    PoseSummary& summary = result.poses[k];
    summary.colliding = summary.colliding_points > 0;
    if (summary.colliding_points + summary.undecided_points > 0)
      summary.distance = of_poses[k].distance->gap(of_poses[k].pair);
  }
  return result;
}

} // namespace pcl_bsh::brute_force
