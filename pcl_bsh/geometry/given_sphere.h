// SPDX-License-Identifier: BSD-3-Clause
// Spheres around points as given, in double and in the cloud's own frame: for places so crowded that the float spheres
// of a local frame cannot tell them apart.
#pragma once

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

struct GivenSphere {
  Point3 center = {0, 0, 0};
  double radius = -1.0; ///< negative: none is known

  bool isKnown() const noexcept { return radius >= 0.0; }
};

/// The sphere around count > 0 points with their radii. @param point gives point 0 .. count - 1. @param ball gives its
/// radius
///
/// Rounding bound: differences of doubles and the sum err by v each. A hypot errs by 4.5 v: it is a coordinate times
/// the root of a sum of squared quotients, one of them 1. kFewDoubleRoundings covers these and its own product. A
/// denormal unit covers a denormal hypot. Differences never underflow.
template <class PointAt, class BallAt>
GivenSphere sphereAround(std::size_t count, const PointAt& point, const BallAt& ball)
{
  Point3 low = point(0), high = low;
  for (std::size_t i = 1; i < count; ++i) {
    const Point3 p = point(i);
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  GivenSphere sphere;
  for (std::size_t k = 0; k < 3; ++k) sphere.center[k] = low[k] == high[k] ? low[k] : low[k] / 2 + high[k] / 2;
  for (std::size_t i = 0; i < count; ++i) {
    const Point3 p = point(i);
    const double distance = std::hypot(p[0] - sphere.center[0], p[1] - sphere.center[1], p[2] - sphere.center[2]);
    sphere.radius = std::max(sphere.radius, distance + ball(i));
  }
  constexpr double denormal = std::numeric_limits<double>::denorm_min();
  if (sphere.radius > 0.0) sphere.radius = sphere.radius * (1.0 + kFewDoubleRoundings) + 2 * denormal;
  return sphere;
}

/// More than the share of a radius by which a pose that is rigid within 1e-6 lengthens it.
inline constexpr double kPoseStretch = 0x1p-20;

/// Whether no point in one sphere collides with any in the other, in exact arithmetic.
inline bool areApart(const ExactDistance& distance, const GivenSphere& a, const GivenSphere& b, double clearance)
{
  constexpr double stretch = 1.0 + kPoseStretch;
  const double radius_a = a.radius * stretch, radius_b = b.radius * stretch;
  return std::isfinite(clearance + radius_a + radius_b) &&
         distance.compare(a.center, b.center, clearance, radius_a, radius_b) > 0;
}

} // namespace pcl_bsh
