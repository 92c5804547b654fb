// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/depths/depths.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/depths/triangle_depths.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/query/record_distance.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace pcl_bsh {
namespace {

Interval about(double rounded)
{
  if (rounded == 0.0) return {0.0, 0.0};
  return {std::nextafter(rounded, 0.0), std::nextafter(rounded, std::numeric_limits<double>::infinity())};
}

/// Depths of points and balls. A ball is enclosed where its middle is.
std::vector<Depth> depthsOfPoints(const DeepSolid& solid, const Placed& queried,
                                  const std::vector<std::uint32_t>& records, unsigned threads, Work& work)
{
  std::vector<Depth> depths;
  if (records.empty()) return depths;
  PointDistancesRequest request;
  request.threads = threads;
  const PointDistances found = pointDistances(queried, records, {solid.surface, solid.pose}, request);
  work += found.work;
  const DefaultFloatEnvironment environment;
  const PointsView& view = queried.hierarchy().view();
  std::vector<float> radii;
  const PointsView below = sunk(view, radii);
  const RecordDistance exact(below, queried.pose, solid.surface.view(), solid.pose);
  for (const std::uint32_t record : records) {
    const std::uint32_t nearest = found.closest_point[record];
    if (std::isnan(found.distance[record])) continue;
    const double depth = view.areBalls() ? exact.gap({record, nearest}) : found.distance[record];
    depths.push_back({record, about(depth), depth, nearest});
  }
  return depths;
}

} // namespace

PointsView sunk(PointsView balls, std::vector<float>& radii)
{
  if (!balls.areBalls()) return balls;
  radii.assign(balls.radii, balls.radii + balls.count);
  for (float& radius : radii) radius = -radius;
  balls.radii = radii.data();
  return balls;
}

std::vector<Depth> depthsOf(const DeepSolid& solid, const QueriedRecords& queried,
                            const Eigen::Isometry3d& T_world_queried, const std::vector<std::uint32_t>& records,
                            unsigned threads, bool deepest, Work& work)
{
  if (queried.isSurface()) return depthsOfTriangles(solid, queried, T_world_queried, records, threads, deepest, work);
  return depthsOfPoints(solid, {queried.thing(), T_world_queried}, records, threads, work);
}

std::vector<std::uint32_t> recordsIn(const DeepSolid& solid, const QueriedRecords& queried,
                                     const Eigen::Isometry3d& T_world_queried, unsigned threads, Work& work)
{
  std::vector<std::uint32_t> enclosed = enclosedBy({solid.solid, solid.pose}, queried, T_world_queried, threads, &work);
  if (!queried.isSurface()) return enclosed;
  PointDistancesRequest touching;
  touching.max_distance = 0.0;
  touching.threads = threads;
  const PointDistances met = pointDistances({queried.thing(), T_world_queried}, {solid.surface, solid.pose}, touching);
  work += met.work;
  std::vector<std::uint32_t> meeting, all;
  for (std::uint32_t i = 0; i < met.distance.size(); ++i)
    if (!std::isnan(met.distance[i])) meeting.push_back(i);
  std::set_union(enclosed.begin(), enclosed.end(), meeting.begin(), meeting.end(), std::back_inserter(all));
  return all;
}

DepthsResult depthsIn(const DeepSolid& solid, const QueriedRecords& queried, const Eigen::Isometry3d& T_world_queried,
                      unsigned threads, bool deepest)
{
  DepthsResult result;
  const std::vector<std::uint32_t> records = recordsIn(solid, queried, T_world_queried, threads, result.work);
  result.depths = depthsOf(solid, queried, T_world_queried, records, threads, deepest, result.work);
  return result;
}

const Depth* deepestOf(const std::vector<Depth>& depths)
{
  const Depth* deepest = nullptr;
  for (const Depth& depth : depths)
    if (depth.told > (deepest != nullptr ? deepest->told : 0.0)) deepest = &depth;
  return deepest;
}

void deepen(DistanceResult& closest, const DeepSolid& solid, bool solid_is_b, const QueriedRecords& queried,
            const Eigen::Isometry3d& T_world_queried, unsigned threads)
{
  const DepthsResult found = depthsIn(solid, queried, T_world_queried, threads, true);
  closest.work += found.work;
  double upper = 0.0;
  for (const Depth& depth : found.depths) upper = std::max(upper, depth.depth.upper);
  const Depth* const deepest = deepestOf(found.depths);
  if (deepest != nullptr && -deepest->told < closest.distance) {
    closest.distance = -deepest->told;
    closest.pair =
        solid_is_b ? PointPair{deepest->record, deepest->nearest} : PointPair{deepest->nearest, deepest->record};
    closest.interval = {-upper, -deepest->depth.lower};
  }
  if (upper > 0.0) closest.interval.lower = std::min(closest.interval.lower, -upper);
}

} // namespace pcl_bsh
