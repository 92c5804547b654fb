// SPDX-License-Identifier: BSD-3-Clause
// The kernels of distances as they are compiled for the instruction set in use: for tests that judge their rounding.
#pragma once

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <Eigen/Geometry>

#include <array>
#include <optional>

namespace pcl_bsh::test {

/// longLengths() and roundedLengths() of one pair. Not known: also where the instruction set has no such arithmetic.
struct LongLength {
  double root, correction;
  bool known;
  double rounded;
};
LongLength longLength(const std::array<double, 3>& p, const std::array<double, 3>& q,
                      const std::array<WithError, 3>& shift);

/// boundDistances() of one sphere to another, in a frame whose unit is between `least` and `most` of the walk's.
struct FrameBounds {
  float prune_reach, least, most;
};
struct DistanceBounds {
  float lower, upper;
};
DistanceBounds boundDistance(const float (&center)[3], float radius, const float (&other)[3], float other_radius,
                             const FrameBounds& frame);

/// boundFromBox() and farthestFromBox() of a box to a sphere.
DistanceBounds boundOfBox(const float (&low)[3], const float (&high)[3], const float (&center)[3], float radius,
                          float stretch, const FrameBounds& frame);

/// nearPartOf() and longDistance() of a point and a triangle under their poses.
struct LongTriangleDistance {
  int kind; ///< NearPart::Kind: 0 where doubles are not sure
  double low, high;
  double rounded; ///< NaN where it is in doubt
};
LongTriangleDistance longTriangleDistance(const Point3& p, const Eigen::Isometry3d& pose_a, const Triangle3& t,
                                          const Eigen::Isometry3d& pose_b);

/// Sign of a point's distance from one triangle less that from another, by areSameParts() and longOrder(); nothing
/// where these do not know.
struct PosedTriangle {
  Triangle3 corners;
  Eigen::Isometry3d pose;
};
std::optional<int> longTriangleOrder(const Point3& p, const Eigen::Isometry3d& pose_a, const PosedTriangle& x,
                                     const PosedTriangle& y);

/// From a place to what is both in a sphere and in one or two slabs.
struct Held {
  std::array<float, 3> normal, cross;
  float h, cross_h;
  std::array<float, 3> center;
  float radius;
};
float lengthToSlabs(const Held& held, const std::array<float, 3>& place);

} // namespace pcl_bsh::test
