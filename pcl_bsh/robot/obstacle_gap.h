// SPDX-License-Identifier: BSD-3-Clause
// How far one solid is from one cloud, or from one mesh, up to a limit.
//
// Where places of points are uncertain, a solid is certainly no nearer to any of them than the lower bound. It is
// certainly no farther from one of them than the upper bound.
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/robot/kinematics.h>
#include <pcl_bsh/robot/shapes/shape.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

namespace pcl_bsh::robots {

/// Bounds of a gap: of a distance less radii.
struct Gap : Interval {
  std::uint32_t record = kNothing;   ///< the nearest, whose upper bound is least; kNothing: all are beyond the limit
  std::uint32_t possible = kNothing; ///< the one whose lower bound is least

  bool isBeyond(double limit) const noexcept { return record == kNothing || lower > limit; }
};

/// Some triangles of a mesh, by their records, and a ball in the world that holds them where they stand.
struct Patch {
  const SphereHierarchy& surface;
  const std::uint32_t *begin, *end;
  Eigen::Vector3d center;
  double radius;

  std::array<Point3, 3> triangle(const std::uint32_t* record) const
  {
    return surface.view().triangles->triangle(*record);
  }
};

/// A cloud or a mesh that solids are held against, where it stands. The hierarchy is borrowed.
class Obstacle {
public:
  explicit Obstacle(const SphereHierarchy& hierarchy);

  const SphereHierarchy& hierarchy() const noexcept { return *hierarchy_; }
  double mostUncertain() const noexcept; ///< no place is more uncertain, m

  Kinematics::Pose pose; ///< T_world_obstacle

  /// Whether the gap of a point is certainly above the limit: quicker than the gap itself. Expects the
  /// DefaultFloatEnvironment.
  bool isBeyond(const Eigen::Vector3d& point, double limit) const;

  /// The gap of a point. Beyond the limit: from that to infinity. Expects the DefaultFloatEnvironment.
  Gap gap(const Eigen::Vector3d& point, double limit) const;

  /// The gap of a solid at a pose in the world.
  Gap gap(const Solid& solid, const Kinematics::Pose& pose, double limit) const;

  /// The gap of a patch, whose mesh is at a pose in the world.
  /// @param any any gap within the limit will do, not the least alone
  Gap gap(const Patch& patch, const Kinematics::Pose& pose, double limit, bool any = false) const;

private:
  const SphereHierarchy* hierarchy_;
  std::optional<double> radius_; ///< of all points, where their radii and uncertainties are alike
};

} // namespace pcl_bsh::robots
