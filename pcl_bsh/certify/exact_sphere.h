// SPDX-License-Identifier: BSD-3-Clause
// Spheres in exact rationals, and the double arithmetic that spares them most of the work. All in the coordinates of a
// LocalFrame: (p - origin) / unit, exactly.
#pragma once

#include <pcl_bsh/geometry/local_frame.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <CGAL/Exact_rational.h>

#include <array>
#include <optional>
#include <vector>

namespace pcl_bsh {

using Exact = CGAL::Exact_rational;
using ExactPoint = std::array<Exact, 3>;

/// A point with its ball: as given, and in the frame's coordinates, rounded to doubles.
struct CertifiedPoint {
  Point3 given;
  double given_radius;
  Point3 local;
  double radius;
};

CertifiedPoint certifiedPoint(const LocalFrame& frame, const Point3& given, double radius);

/// A sphere as a node stores it.
struct StoredSphere {
  float x, y, z, r;
};

/// True: the point's ball is certainly in the sphere. False: it may be in it or not.
bool surelyContains(const StoredSphere& sphere, const CertifiedPoint& point);

/// How far the point's ball sticks out of the sphere, in the clouds' unit; 0 when it does not. Exact, apart from the
/// rounding of the result.
double excess(const LocalFrame& frame, const StoredSphere& sphere, const CertifiedPoint& point);

/// Stored radius over the radius of the smallest sphere around the points and their balls: exact for points; for balls
/// to some 1e-10. None when the smallest radius is 0.
/// @param points at least one
/// @throws std::logic_error when, for points without balls, the sphere is smaller than the smallest, which only a leak
///   explains.
std::optional<double> radiusRatio(const LocalFrame& frame, const StoredSphere& sphere,
                                  const std::vector<CertifiedPoint>& points);

} // namespace pcl_bsh
