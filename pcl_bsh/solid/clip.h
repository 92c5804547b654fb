// SPDX-License-Identifier: BSD-3-Clause
// The part of a polygon that is between two planes across an axis.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <cmath>
#include <cstddef>
#include <limits>

namespace pcl_bsh {

/// Calls visit(p) for the corners of that part of a convex polygon which lies between two planes across an axis; some
/// twice.
template <class Visit>
void forEachCorner(const Point3* corners, std::size_t count, std::size_t axis, double low, double high,
                   const Visit& visit)
{
  for (std::size_t i = 0; i < count; ++i) {
    const Point3 &u = corners[i], &v = corners[i + 1 < count ? i + 1 : 0];
    if (u[axis] >= low && u[axis] <= high) visit(u);
    const bool upward = u[axis] < v[axis];
    for (const double at : {upward ? low : high, upward ? high : low}) {
      if ((u[axis] < at) == (v[axis] < at) || !(std::abs(at) < std::numeric_limits<double>::infinity())) continue;
      const double share = (at - u[axis]) / (v[axis] - u[axis]);
      Point3 p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = u[k] + (v[k] - u[k]) * share;
      visit(p);
    }
  }
}

} // namespace pcl_bsh
