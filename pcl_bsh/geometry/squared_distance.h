// SPDX-License-Identifier: BSD-3-Clause
// Squared distances of two points as floats, rounded once: they keep the order of the exact ones.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/geometry/rounding.h>

namespace pcl_bsh {

/// The float nearest to |p - q|^2 (ties to even), in exact arithmetic. @param approximate |p - q|^2 in double, straight
/// from the coordinates: the search begins there
float settleSquaredDistance(const Point3& p, const Point3& q, double approximate);

/// The float nearest to |p - q|^2 (ties to even; infinity beyond the largest). A larger distance never gives a smaller
/// one. Any finite coordinates; expects the DefaultFloatEnvironment.
inline float squaredDistanceAsFloat(const Point3& p, const Point3& q)
{
  const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
  const double squared = x * x + y * y + z * z; // rounded five times, unless it is so tiny that it counts as 0
  const float below = roundToFloat(squared * (1.0 - kFewDoubleRoundings));
  const float above = roundToFloat(squared * (1.0 + kFewDoubleRoundings));
  if (below == above) return below;
  return settleSquaredDistance(p, q, squared);
}

} // namespace pcl_bsh
