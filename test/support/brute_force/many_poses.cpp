// SPDX-License-Identifier: BSD-3-Clause
#include "many_poses.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/many_poses/motions_query.h>
#include <pcl_bsh/query/brute_force_points.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/trajectory/leaf/point_segment.h>
#include <pcl_bsh/trajectory/leaf/record_course.h>

#include <algorithm>

namespace pcl_bsh::brute_force {
namespace {

/// Whether a record of the scan comes near enough to one of the model in the part of the path after pose k of it.
bool comeNear(const TrajectoryQuery& query, std::uint32_t k, const FinitePoint& p, const FinitePoint& q)
{
  PathInterval part;
  part.first = k;
  part.last = k + 1;
  const double near_enough = query.nearEnough({p.record, q.record});
  if (near_enough < 0.0) return false;
  if (query.of_points) return PointSegment(query, p.record, part).approachTo(query, q.record, near_enough).contact;
  return RecordCourse(query, p.record, part).approachTo(query, q.record, part, near_enough, false).contact;
}

/// Whether any pair, of points that are where `places` says, collides on the motion.
bool collideOn(const MotionsQuery& query, const RigidMotion& motion, MeantPlaces places,
               const std::vector<FinitePoint>& points, const std::vector<FinitePoint>& obstacles, Work& work)
{
  const std::vector<Eigen::Isometry3d> ends = {motion.from(), motion.to()};
  const std::function<bool(double)> silent;
  Progress progress(silent);
  TrajectoryResult unused;
  const TrajectoryQuery path(query.scan, query.model, query.boxes, ends, query.swept, unused, progress, places,
                             Wanted::witness);
  const auto collides = [&](const FinitePoint& p, const FinitePoint& q) {
    ++work.exact_decisions;
    for (const Eigen::Isometry3d& pose : ends)
      if (path.of_pairs.holds(RecordDistance(query.scan.hierarchy().view(), query.scan.pose, query.model.view(), pose),
                              {p.record, q.record}))
        return true;
    for (std::uint32_t k = 0; k + 1 < path.path.poses.size(); ++k)
      if (comeNear(path, k, p, q)) return true;
    return false;
  };
  return std::any_of(points.begin(), points.end(), [&](const FinitePoint& p) {
    return std::any_of(obstacles.begin(), obstacles.end(), [&](const FinitePoint& q) { return collides(p, q); });
  });
}

} // namespace

AnyOnMotions anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                                   const std::vector<PoseMotion>& motions, const MotionsRequest& request)
{
  check(scan, poses, motions, request);
  const DefaultFloatEnvironment environment;
  AnyOnMotions result;
  result.flags.assign(motions.size(), Verdict::free);
  if (scan.hierarchy().empty() || model.empty()) return result;
  const MotionsQuery query(scan, model, request);
  std::vector<std::uint32_t> used;
  for (const PoseMotion& motion : motions) used.insert(used.end(), {motion.from, motion.to});
  checkSwept(query, poses, used, motions);
  const std::vector<FinitePoint> points = finitePoints(scan.hierarchy().view()), obstacles = finitePoints(model.view());
  const bool uncertain = areUncertain(scan, {model});
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const RigidMotion motion = motionBetween(poses[motions[m].from], poses[motions[m].to], request.pivot);
    const auto collides = [&](MeantPlaces places) {
      return collideOn(query, motion, places, points, obstacles, result.work);
    };
    if (!collides(uncertain ? MeantPlaces::possible : MeantPlaces::measured)) continue;
    const bool certain = !uncertain || collides(MeantPlaces::certain);
    result.flags[m] = certain ? Verdict::colliding : Verdict::undecided;
    ++(certain ? result.colliding : result.undecided);
  }
  return result;
}

AnyAtPoses anyCollisionAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                               const AnyRequest& request)
{
  AnyAtPoses result;
  for (std::size_t i = 0; i < T_world_b.size(); ++i) {
    const AnyResult found = brute_force::anyCollision(a, {b, T_world_b[i]}, request);
    result.flags.push_back(found.verdict);
    result.colliding += found.verdict == Verdict::colliding;
    result.undecided += found.verdict == Verdict::undecided;
    result.work += found.work;
  }
  return result;
}

DistancesAtPoses closestPairAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                                    const DistanceRequest& request)
{
  DistancesAtPoses result;
  for (std::size_t i = 0; i < T_world_b.size(); ++i) {
    const DistanceResult found = brute_force::closestPair(a, {b, T_world_b[i]}, request);
    result.distances.push_back(found.distance);
    if (!a.hierarchy().empty() && !b.empty())
      result.pairs.push_back(found.pair.value_or(PointPair{kNothing, kNothing}));
    result.work += found.work;
  }
  return result;
}

} // namespace pcl_bsh::brute_force
