// SPDX-License-Identifier: BSD-3-Clause
// When two moving points first come near each other.
#pragma once

#include <pcl_bsh/query/scene/path.h>

#include <optional>

namespace pcl_bsh {

/// How near is near: two points within `reach` collide. Who approaches is halted at the outer distance; who is between
/// outer and inner already is let pass as long as it stays outside of inner. So what has been halted can move along and
/// away, and rounding, far below the distance from inner to reach, never leads to a collision.
struct ContactZone {
  double reach;
  double tolerance;

  double outer() const { return reach + 0.5 * tolerance; }
  double inner() const { return reach + 0.25 * tolerance; }
};

/// Points `apart` (from the other to the moving one), the moving one going by `shift` while s runs from 0 to 1.
/// @return s of the contact, in [0, 1]
std::optional<double> meeting(const Eigen::Vector3d& apart, const Eigen::Vector3d& shift, const ContactZone& zone);

/// Points p and q, given in their objects' frames, on their paths, for s from `begin` to `end`. Conservative
/// advancement (Mirtich and Canny, Impulse-based Simulation of Rigid Bodies, 1995): no step is longer than the distance
/// left over the speed of both.
std::optional<double> meeting(const Path& path_a, const Eigen::Vector3d& p, const Path& path_b,
                              const Eigen::Vector3d& q, const ContactZone& zone, double begin, double end);

} // namespace pcl_bsh
