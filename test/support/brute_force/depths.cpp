// SPDX-License-Identifier: BSD-3-Clause
#include "depths.h"

#include "labels.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/query/record_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::brute_force {
namespace {

constexpr double farther = std::numeric_limits<double>::infinity();

struct Place {
  bool enclosed;
  double distance; ///< to the surface
  std::uint32_t nearest;
};

/// Looks at each place of a view, which has no radii or sunk ones.
std::vector<Place> lookAt(const PointsView& places, const Eigen::Isometry3d& pose, const DeepSolid& solid, Work& work)
{
  PointsView middles = places;
  middles.radii = nullptr;
  const LabelsResult labels = labelPoints({SphereHierarchy(middles), pose}, {solid.solid, solid.pose});
  const DefaultFloatEnvironment environment;
  const RecordDistance distance(places, pose, solid.surface.view(), solid.pose);
  const TrianglesView& triangles = solid.solid.triangles();
  std::vector<Place> found;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::uint32_t record = places.record(i);
    Place at = {labels.labels[record] != labelOf(Label::outside), farther, 0};
    bool any = false;
    for (std::uint32_t t = 0; t < triangles.count && isFinite(places.point(record)); ++t) {
      if (!isFinite(triangles.triangle(t))) continue;
      ++work.exact_decisions;
      if (any && distance.compareGaps(PointPair{record, t}, PointPair{record, at.nearest}) >= 0) continue;
      any = true;
      at.nearest = t;
    }
    if (any) at.distance = distance.gap(PointPair{record, at.nearest});
    found.push_back(at);
  }
  return found;
}

} // namespace

DepthsResult depthsIn(const DeepSolid& solid, const QueriedRecords& queried, const Eigen::Isometry3d& T_world_queried,
                      unsigned steps)
{
  DepthsResult result;
  const PointsView& view = queried.thing().view();
  if (!queried.isSurface()) {
    std::vector<float> radii;
    const std::vector<Place> places = lookAt(sunk(view, radii), T_world_queried, solid, result.work);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto [enclosed, depth, nearest] = places[i];
      const double low = depth == 0.0 ? 0.0 : std::nextafter(depth, 0.0);
      if (enclosed)
        result.depths.push_back(
            {view.record(i), {low, depth == 0.0 ? 0.0 : std::nextafter(depth, farther)}, depth, nearest});
    }
    return result;
  }
  for (const std::uint32_t record : queried.triangles()) {
    const std::array<Point3, 3> t = view.triangles->triangle(record);
    std::vector<Point3> grid;
    for (unsigned i = 0; i <= steps; ++i)
      for (unsigned j = 0; i + j <= steps; ++j) {
        Point3 at = t[0];
        for (std::size_t k = 0; k < 3; ++k)
          at[k] += (t[1][k] - t[0][k]) * (double(i) / steps) + (t[2][k] - t[0][k]) * (double(j) / steps);
        grid.push_back(at);
      }
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3 &p = t[k], &q = t[(k + 1) % 3];
      longest = std::max(longest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
    Depth depth;
    depth.record = record;
    depth.depth.lower = 0.0;
    double signed_upper = -farther;
    for (const Place& place : lookAt(viewOf(grid.front().data(), grid.size()), T_world_queried, solid, result.work)) {
      signed_upper = std::max(signed_upper, place.enclosed ? place.distance : -place.distance);
      if (!place.enclosed || place.distance < depth.depth.lower) continue;
      depth.depth.lower = depth.told = place.distance;
      depth.nearest = place.nearest;
    }
    // Within a cell of the grid no place is farther than 1 / sqrt(3) of its longest side from a corner.
    depth.depth.upper = signed_upper + longest / steps * 0.58;
    if (depth.depth.upper >= 0.0) result.depths.push_back(depth);
  }
  return result;
}

} // namespace pcl_bsh::brute_force
