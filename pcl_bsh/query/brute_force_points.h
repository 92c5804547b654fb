// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_bsh::brute_force {

/// A point that takes part in collisions; of a triangle, the middle of its ball.
struct FinitePoint {
  std::uint32_t record;
  Point3 point;
  double radius;
  double uncertainty; ///< its own, beside that of all points
};

/// The finite points of a view by ascending record: the first pair found is the smallest.
inline std::vector<FinitePoint> finitePoints(const PointsView& view)
{
  std::vector<FinitePoint> points;
  points.reserve(view.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    const Point3 point = view.point(record);
    const bool finite = std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); });
    if (finite) points.push_back({record, point, view.ownRadius(record), view.ownUncertainty(record)});
  }
  std::sort(points.begin(), points.end(),
            [](const FinitePoint& x, const FinitePoint& y) { return x.record < y.record; });
  return points;
}

} // namespace pcl_bsh::brute_force
