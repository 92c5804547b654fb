// SPDX-License-Identifier: BSD-3-Clause
// When two moving points first come near each other.
#pragma once

#include <pcl_bsh/geometry/rigid_motion.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/separation.h>

#include <cmath>
#include <limits>
#include <optional>

namespace pcl_bsh {

/// The distances at which a pair collides or is halted. Two points within `reach` collide. A pair that approaches is
/// halted at the outer distance. A pair that starts between outer and inner may pass as long as it stays outside of
/// inner. So a halted object can move along and away. Rounding is far below the distance from inner to reach, and never
/// leads to a collision.
struct ContactZone {
  static constexpr double kNowRounding = 32 * kDoubleUnit; ///< of a distance, as it is measured

  double reach;
  double tolerance;

  double outer() const { return reach + 0.5 * tolerance; }
  double inner() const { return reach + 0.25 * tolerance; }

  /// Next to the reach, the distance to a collision is no longer far above what rounding takes.
  bool isNext(double now) const { return now <= reach + 0.125 * tolerance; }

  /// How near a pair may come that is within outer from the start: to inner, or, if it is hardly farther than that, a
  /// little nearer than now. Next to the reach: no nearer than rounding has it. There the pair may still move along and
  /// away, and whether it collides on its way is another question (timeOfContact()).
  double floor(double now) const
  {
    if (!isNext(now)) return std::min(inner(), now - 0.0625 * tolerance);
    return now * (1.0 - kNowRounding);
  }
};

/// Returns the reach of a zone: the sum of its terms, rounded so that it is no less than the exact sum.
template <class Terms>
double reachOf(const Terms& terms)
{
  double reach = 0.0;
  for (const double term : terms) {
    const WithError sum = twoSum(reach, term);
    reach = sum.error > 0.0 ? std::nextafter(sum.value, std::numeric_limits<double>::infinity()) : sum.value;
  }
  return reach;
}

/// Points `apart` (from the other to the moving one), the moving one going by `shift` while s runs from 0 to 1. If
/// the pair is next to the reach from the start, rounding decides.
/// @return s of the contact, in [0, 1]
std::optional<double> timeOfContact(const Eigen::Vector3d& apart, const Eigen::Vector3d& shift,
                                    const ContactZone& zone);

/// Points or triangles, given in their objects' frames, on their motions, for s from `begin` to `end`. Conservative
/// advancement (Mirtich and Canny, Impulse-based Simulation of Rigid Bodies, 1995) with a bound of second order: where
/// two of them hardly come nearer, steps grow with the square root of what is left.
///
/// Two points that go straight and are next to the reach from the start have a contact, at once, if they come nearer
/// and within the reach at any instant. Exact arithmetic on the corners and the poses decides it. Others that
/// are next to the reach, by no more than rounding may take, have one at once if they come nearer.
std::optional<double> timeOfContact(const RigidMotion& motion_a, const Corners& a, const RigidMotion& motion_b,
                                    const Corners& b, const ContactZone& zone, double begin, double end);

/// Corners as a pose places them.
Corners placedBy(const Eigen::Isometry3d& pose, const Corners& corners);

} // namespace pcl_bsh
