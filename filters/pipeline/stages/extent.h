// SPDX-License-Identifier: BSD-3-Clause
// How far a cloud reaches.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <algorithm>
#include <cstdint>

namespace pcl_bsh::pipeline {

/// The box of a cloud's finite points, in double; a point at 0 where there are none.
struct Extent {
  Point3 least = {0, 0, 0};
  Point3 most = {0, 0, 0};
};

inline Extent extentOf(const PointsView& points)
{
  Extent extent;
  bool first = true;
  for (std::uint32_t i = 0; i < points.count; ++i) {
    const Point3 p = points.point(i);
    if (!isFinite(p)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      extent.least[k] = first ? p[k] : std::min(extent.least[k], p[k]);
      extent.most[k] = first ? p[k] : std::max(extent.most[k], p[k]);
    }
    first = false;
  }
  return extent;
}

} // namespace pcl_bsh::pipeline
