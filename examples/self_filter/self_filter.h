// SPDX-License-Identifier: BSD-3-Clause
// Which points of a scan are the robot that scans?
//
//   SelfFilter filter(readRobot("arm.urdf"), {});
//   const std::vector<std::uint8_t>& mine = filter.flags(viewOf(cloud), T_cloud_root, {{"elbow", 0.7}});
//
// A point that is not flagged is farther than the padding from the robot's surface, for certain; one that is flagged is
// within padding + tolerance.
#pragma once

#include "self_filter/link_body.h"
#include "self_filter/robot.h"

#include <pcl_bsh/collision/colliding_indices.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace pcl_bsh::self_filter {

struct Settings {
  double padding = 0.02;    ///< m, finite and >= 0
  double tolerance = 0.005; ///< of the surfaces' covers, m, finite and > 0
  unsigned threads = 1;     ///< 0: all of the machine's
};

/// Covers all links once; a new frame builds the scan's hierarchy, and of that only what is near the robot.
class SelfFilter {
public:
  /// @throws as bodyOf() does
  SelfFilter(Robot robot, const Settings& settings);

  const Robot& robot() const { return robot_; }
  std::size_t balls() const; ///< of all links

  /// One per record of the scan: 1 where it is the robot. Valid until the next call.
  /// @param T_scan_root where the robot's root is in the scan's frame
  /// @throws std::runtime_error as Robot::requireValues() does; std::invalid_argument as SphereHierarchy does
  const std::vector<std::uint8_t>& flags(const PointsView& scan, const Eigen::Isometry3d& T_scan_root,
                                         const JointValues& values);

private:
  Robot robot_;
  FlagsRequest request_;
  std::vector<std::unique_ptr<const LinkBody>> bodies_; ///< of all links
  std::vector<SphereHierarchy> hierarchies_;            ///< of the bodies
  CollidingIndices hit_;
  std::vector<std::uint8_t> flags_;
};

} // namespace pcl_bsh::self_filter
