// SPDX-License-Identifier: BSD-3-Clause
// Distances of records that solids hold: the negative depth to the surface.
#include <pcl_bsh/question/solids.h>

#include <pcl_bsh/depths/depths_along.h>
#include <pcl_bsh/distances/point_distances.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pcl_bsh {
namespace {

/// Returns the interval of the distance.
Interval turned(const Interval& depth)
{
  return {-depth.upper, 0.0 - depth.lower};
}

/// Adds the interval that certainly holds the distance of each record, where it was measured exactly.
void tellIntervals(PointDistances& found)
{
  if (!found.interval.empty()) return;
  constexpr double none = std::numeric_limits<double>::quiet_NaN(), beyond = std::numeric_limits<double>::infinity();
  for (const double distance : found.distance)
    found.interval.push_back(std::isnan(distance)
                                 ? Interval{none, none}
                                 : Interval{std::nextafter(distance, -beyond), std::nextafter(distance, beyond)});
}

} // namespace

DeepSolid Solids::deepSolid(const Pairing& pair, const Eigen::Isometry3d& pose) const
{
  return {pair.solid.whole(), (pair.of_obstacle ? b_ : a_).hierarchy(), poseOfSolid(pair, pose)};
}

void Solids::turn(SymmetricDistances& found, bool both_ways) const
{
  for (const Pairing& pair : pairings_)
    if (pair.of_obstacle || both_ways) turn(pair, pair.of_obstacle ? found.a : found.b);
}

void Solids::turn(const Pairing& pair, PointDistances& found) const
{
  const DepthsResult depths =
      depthsIn(deepSolid(pair, b_.pose), pair.queried, poseOfQueried(pair, b_.pose), question_.threads);
  found.work += depths.work;
  if (pair.queried.isSurface() && !depths.depths.empty()) tellIntervals(found);
  for (const Depth& depth : depths.depths) {
    double& distance = found.distance[depth.record];
    found.measured += std::isnan(distance);
    if (std::isnan(distance) || depth.told > 0.0) {
      distance = 0.0 - depth.told;
      found.closest_point[depth.record] = depth.nearest;
    }
    if (!found.interval.empty()) found.interval[depth.record] = turned(depth.depth);
  }
  found.greatest = std::numeric_limits<double>::quiet_NaN();
  found.greatest_pair.reset();
  for (std::uint32_t i = 0; i < found.distance.size(); ++i) {
    if (!(found.distance[i] > found.greatest) && !(std::isnan(found.greatest) && !std::isnan(found.distance[i])))
      continue;
    found.greatest = found.distance[i];
    found.greatest_pair = PointPair{i, found.closest_point[i]};
  }
}

void Solids::turn(DistanceResult& closest, const Eigen::Isometry3d& pose) const
{
  for (const Pairing& pair : pairings_)
    deepen(closest, deepSolid(pair, pose), pair.of_obstacle, pair.queried, poseOfQueried(pair, pose),
           question_.threads);
}

/// Returns the records of the queried thing that the solid may hold somewhere along the path.
Solids::Records Solids::mayBeDeep(const Pairing& pair, const FirstPoses& first, const TrajectoryResult& found) const
{
  Records records;
  if (!pair.of_obstacle) { // nothing is known of the obstacle's records
    records.resize(pair.queried.thing().view().count);
    std::iota(records.begin(), records.end(), 0U);
    return records;
  }
  const bool between = question_.swept > 0.0;
  for (std::uint32_t i = 0; i < first.possible.size(); ++i) {
    bool may = first.possible[i] != kNothing;
    if (pair.queried.isSurface() || between) { // a record that is inside at no pose may cross the surface
      if (!found.distance.empty())
        may |= static_cast<double>(found.distance[i]) <= question_.swept;
      else
        may |= found.flags.empty() || found.flags[i] != Verdict::free;
    }
    if (may) records.push_back(i);
  }
  return records;
}

/// Adds depths. Where the input is the solid, the depth of a record goes to the triangle nearest to its deepest place.
/// Other triangles whose body holds something get a distance of 0.
void Solids::addDepths(const Pairing& pair, const FirstPoses& first, const std::vector<Eigen::Isometry3d>& poses,
                       const Point3& pivot, TrajectoryResult& found, std::vector<double>& at_poses, Work& work) const
{
  if (found.distance.empty() && found.poses.empty()) return;
  const QueriedPart part(pair.queried.thing(), mayBeDeep(pair, first, found));
  DepthPath path{poses, a_.pose, pair.of_obstacle, question_.sweptTolerance(), pivot, question_.threads};
  std::vector<double> deepest;
  const std::vector<DepthAlong> depths =
      depthsAlong(deepSolid(pair, poses.front()), part, path, work, found.poses.empty() ? nullptr : &deepest);
  for (std::size_t k = 0; k < deepest.size(); ++k) at_poses[k] = std::max(at_poses[k], deepest[k]);
  if (found.distance.empty()) return;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (!depths.empty() && found.interval.empty()) found.interval.assign(found.distance.size(), Interval{nan, nan});
  const auto bound = [&](std::uint32_t record, const Interval& depth) {
    Interval& interval = found.interval[record];
    interval.lower = std::fmin(interval.lower, -depth.upper);
    interval.upper = std::fmin(interval.upper, 0.0 - depth.lower);
  };
  const auto tell = [&](std::uint32_t record, double distance, std::uint32_t pose, std::uint32_t other) {
    const auto rounded = static_cast<float>(distance);
    if (found.distance[record] <= rounded) return;
    found.distance[record] = rounded;
    if (!found.closest_pose.empty()) found.closest_pose[record] = static_cast<std::int32_t>(pose);
    if (!found.closest_point.empty()) found.closest_point[record] = other;
  };
  for (const DepthAlong& depth : depths) {
    if (pair.of_obstacle) {
      bound(depth.record, depth.depth);
      if (depth.told > 0.0 || first.possible[depth.record] != kNothing)
        tell(depth.record, 0.0 - depth.told, depth.pose, depth.nearest);
      continue;
    }
    if (!(depth.told > 0.0)) continue;
    std::uint32_t triangle = depth.nearest;
    if (first.possible[triangle] == kNothing && !(found.distance[triangle] <= question_.swept)) // of another body
      triangle = holderOf(pair.solid, a_.pose, pair.queried, poses[depth.pose], depth.record, &work);
    bound(triangle, depth.depth);
    tell(triangle, -depth.told, depth.pose, depth.record);
  }
  if (pair.of_obstacle) return;
  std::vector<PoseRecord> of_others;
  for (std::uint32_t i = 0; i < first.possible.size(); ++i) {
    if (first.possible[i] == kNothing || found.distance[i] <= 0.0f) continue;
    tell(i, 0.0, first.possible[i], kNothing);
    if (!found.closest_point.empty()) of_others.emplace_back(first.possible[i], i);
  }
  findOthers(pair, std::move(of_others), poses, found.closest_point, work);
}

} // namespace pcl_bsh
