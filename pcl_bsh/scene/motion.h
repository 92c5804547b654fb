// SPDX-License-Identifier: BSD-3-Clause
// How an object of a scene moves by itself. Times in seconds, angles in radians, lengths in the clouds' unit.
#pragma once

#include <pcl_bsh/export.h>

#include <Eigen/Geometry>

#include <variant>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// At rest, until its pose is set.
struct NoMotion {};

/// Straight on, turning about its own origin; both as the world sees them.
struct VelocityMotion {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();  ///< per second
  Eigen::Vector3d angular = Eigen::Vector3d::Zero(); ///< axis times radians per second
};

/// Around an axis of the world.
struct CircularMotion {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(); ///< any length but 0
  double speed = 0.0;                              ///< radians per second
  bool turning = true;                             ///< false: keeps its rotation, as a gondola does
};

/// From pose to pose: the object's origin moves in a straight line at constant speed, and the object turns in the
/// shorter direction at constant speed; poses between waypoints have the nearest rotations. At rest before the first
/// and after the last.
struct WaypointMotion {
  std::vector<double> times; ///< strictly ascending, as many as poses
  std::vector<Eigen::Isometry3d> poses;
};

/// How an object moves by itself.
using Motion = std::variant<NoMotion, VelocityMotion, CircularMotion, WaypointMotion>;

/// Where `motion` has an object at `time`, which stood at `start` at time 0. Waypoints are in the world: they do not
/// look at `start`.
Eigen::Isometry3d poseAt(const Motion& motion, const Eigen::Isometry3d& start, double time);

/// How `motion` turns an object from one time to a later one, about the world's axes: axis times radians, of any
/// length, full turns included. For waypoints: the sum of the turns from each to the next, at most half a turn
/// each.
Eigen::Vector3d turnOf(const Motion& motion, double from, double to);

/// A piece of an object's motion: one point of the object moves in a straight line at constant speed, and the object
/// turns at constant speed about an axis of fixed direction, by any angle.
struct Leg {
  Eigen::Isometry3d from = Eigen::Isometry3d::Identity(); ///< T_world_object
  Eigen::Isometry3d to = Eigen::Isometry3d::Identity();   ///< T_world_object at the end
  Eigen::Vector3d center = Eigen::Vector3d::Zero(); ///< the point that moves in a straight line, in the object's frame
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();   ///< from `from` to `to`, as the world sees it: axis times radians

  /// @param s in [0, 1], clamped; at(0) and at(1) are `from` and `to` themselves
  Eigen::Isometry3d at(double s) const;
};

/// @throws std::invalid_argument saying what is wrong: numbers that are not finite, an axis of length 0, waypoints
///   without poses or with a pose that is not rigid. Also times that do not ascend, or are not as many as the poses.
void check(const Motion& motion);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
