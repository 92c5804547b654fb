// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <cmath>

namespace pcl_bsh {

/// The distance of two places, within 5 v of it. Infinite where a difference is infinite. There the hypot of three
/// arguments gives NaN in libstdc++, and comparisons would lose a NaN.
inline double distanceBetween(const Point3& p, const Point3& q) noexcept
{
  return std::hypot(std::hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
}

} // namespace pcl_bsh
