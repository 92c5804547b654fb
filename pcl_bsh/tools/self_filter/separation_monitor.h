// SPDX-License-Identifier: BSD-3-Clause
// How far may a robot go on along its planned motion, by what its depth camera sees now? One call for each frame.
//
//   SeparationMonitor monitor(arm, {0.02}, {0.05});  // points within 2 cm are the arm; 5 cm from all others
//   const SeparationCheck check = monitor.check(viewOf(frame), T_world_camera, now, in_half_a_second);
//   if (check.motion.verdict != Verdict::free) stopBefore(check.motion.last_valid);
//
// The motion is certified up to there at every instant (RobotWorld::checkMotion()), against all points that the frame
// has. It is not held against places that the camera does not see, nor against points within the padding of the robot.
#pragma once

#include "self_filter.h"

#include <pcl_bsh/robot/robot_world.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace pcl_bsh::self_filter {

/// The answer of a frame about a motion.
struct SeparationCheck {
  robots::MotionCheck motion;     ///< with last_valid; a meeting's record is one of the frame
  std::size_t near = 0, self = 0; ///< numbers of points that the motion may come near; of the robot among them
};

/// A copy of the few points of a frame that matter. Answers about it have an entry for each of these points alone.
class NearPoints {
public:
  /// A view of these records, valid until the next call.
  PointsView take(const PointsView& frame, const std::vector<std::int32_t>& records);

private:
  std::vector<unsigned char> coordinates_;
  std::vector<float> radii_, uncertainties_;
};

/// Keeps the robot's hierarchies, and builds those of a frame from points near the motion alone.
class SeparationMonitor {
public:
  /// @param filter how points of the robot are recognised
  /// @param options the base is the robot's root in the world
  /// @throws as SelfFilter and RobotWorld do
  SeparationMonitor(const Robot& robot, const Settings& filter, const robots::WorldOptions& options);

  /// @param frame points of a sensor; radii and uncertainties count. Exactly 0 0 0 is no return
  /// @param now where the joints are. @param next the end of the planned motion: a line in joint space
  /// @throws InvalidInput as RobotWorld::checkMotion() does, and for a pose that is not rigid within 1e-6
  SeparationCheck check(const PointsView& frame, const Eigen::Isometry3d& T_world_camera, const robots::RobotState& now,
                        const robots::RobotState& next);

  /// Warnings about the links, a sentence each: meshes that do not close.
  const std::vector<std::string>& warnings() const { return filter_.warnings(); }

private:
  SelfFilter filter_;
  robots::RobotWorld world_;
  std::vector<std::int32_t> records_; ///< of the frame, near the motion
  NearPoints near_;                   ///< the points of records_
  std::vector<std::int32_t> others_;  ///< numbers in near_ of points that are not the robot
  std::unique_ptr<const SphereHierarchy> obstacle_;
};

} // namespace pcl_bsh::self_filter
