// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/roadmap/motion_batch.h>

#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/trajectory/leaf/closest_approach.h>
#include <pcl_bsh/trajectory/walk.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

TrajectoryRequest requestOfOne(const MotionsRequest& asked)
{
  TrajectoryRequest request;
  request.clearance = asked.clearance;
  request.swept = asked.tolerance;
  request.pivot = asked.pivot;
  request.flags = false;
  return request;
}

bool comesFirst(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other)
{
  const double *const a = one.matrix().data(), *const b = other.matrix().data();
  return !std::lexicographical_compare(b, b + 16, a, a + 16);
}

/// A point of the world, seen by a body at a pose.
Eigen::Vector3d seen(const Eigen::Isometry3d& pose, const Eigen::Vector3d& world)
{
  return pose.linear().transpose() * (world - pose.translation());
}

} // namespace

MotionsQuery::MotionsQuery(const Placed& scan_at, const SphereHierarchy& model_of, const MotionsRequest& asked)
: scan(scan_at),
  model(model_of),
  request(asked),
  boxes(model_of.storage(), Travel()), // of motions in all directions
  swept(requestOfOne(asked))
{
  ask(possiblePlaces(scan, {model}));
}

void MotionsQuery::ask(Places where)
{
  places = where;
  beyond = std::max(0.0, reachBetween(scan, {model}, request.clearance, places).most + request.tolerance);
}

RigidMotion motionBetween(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other, const Point3& pivot)
{
  const bool forward = comesFirst(one, other);
  const Eigen::Isometry3d &from = forward ? one : other, &to = forward ? other : one;
  return RigidMotion(from, to, {pivot[0], pivot[1], pivot[2]}, shorterTurn(from.linear(), to.linear()));
}

/// A point goes half of the pivot's way from the middle, and half of the turn about it. Rounding: a few v of all that
/// is added.
double extentAround(const Eigen::Isometry3d& middle, const RigidMotion& motion, const BodyBall& body)
{
  const double away = (body.center - motion.pivot()).norm() + body.radius;
  const double bound = 0.5 * motion.shift().norm() + motion.turningReach(away, 0.5);
  const double added = body.center.lpNorm<1>() + motion.pivot().lpNorm<1>() + motion.worldPivot().lpNorm<1>() +
                       motion.shift().lpNorm<1>() + middle.translation().lpNorm<1>() + body.radius;
  const double safe = bound * (1.0 + 0x1p-40) + added * 0x1p-45;
  return std::isfinite(safe) ? safe : std::numeric_limits<double>::infinity();
}

bool collidesDuring(const MotionsQuery& query, const RigidMotion& motion, const PointPair& pair, Work& work)
{
  const Point3 p = query.scan.hierarchy().view().point(pair.a), q = query.model.view().point(pair.b);
  const Eigen::Vector3d world = query.scan.pose * Eigen::Vector3d(p[0], p[1], p[2]);
  const Eigen::Vector3d start = seen(motion.from(), world), way = seen(motion.to(), world) - start;
  const ClosestApproach approach = closestApproach({start[0] - q[0], start[1] - q[1], start[2] - q[2]},
                                                   {way[0], way[1], way[2]}, std::numeric_limits<double>::infinity());
  const Placed model{query.model, motion.at(approach.at)};
  return PointPairs(query.scan, model, query.request.clearance, query.places).collide(pair, work);
}

std::optional<PointPair> findOnMotion(const MotionsQuery& query, const RigidMotion& motion, Progress& progress,
                                      Work& work)
{
  const std::function<bool(double)> goesOn = [&progress](double) { return !progress.pulse(); };
  Progress own(goesOn);
  TrajectoryResult counted;
  const std::vector<Eigen::Isometry3d> ends = {motion.from(), motion.to()};
  const TrajectoryQuery path(query.scan, query.model, query.boxes, ends, query.swept, counted, own, query.places,
                             Wanted::witness);
  const StopRule never(Accuracy::exact());
  std::vector<TrajectoryQuery::NearVoxel> near;
  path.collectNear(never, own, near);
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& one, const auto& other) { return one.voxel < other.voxel; });
  std::optional<PointPair> witness;
  std::vector<std::uint32_t> intervals;
  for (std::size_t i = 0; i < near.size() && !witness;) {
    const std::uint32_t voxel = near[i].voxel;
    intervals.clear();
    for (; i < near.size() && near[i].voxel == voxel; ++i) intervals.push_back(near[i].interval);
    const VoxelResult found = walkVoxel(path, never, voxel, intervals, own);
    own.throwIfStopped();
    counted.work += found.work;
    witness = found.witness;
  }
  work += counted.work;
  return witness;
}

} // namespace pcl_bsh
