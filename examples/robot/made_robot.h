// SPDX-License-Identifier: BSD-3-Clause
// An arm with a gripper and a camera on a mast, to try the filter on: a URDF, meshes, and what the camera sees.
#pragma once

#include <pcl_bsh/tools/self_filter/link_body.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pcl_bsh::self_filter {

/// Ten links with bodies (boxes, cylinders, a sphere, three meshes) and the link `camera`, whose z looks forward and y
/// down; joints of every kind that readRobot() knows, one of which mimics another.
/// @param folder gets robot.urdf and meshes/*.stl; is there
/// @throws files::FileError
void writeMadeRobot(const std::filesystem::path& folder);

/// The joints of the made robot at a frame of so many: it reaches over a table.
JointValues madeJointValues(std::size_t frame, std::size_t frames);

/// The image of a depth camera, in its own frame.
struct DepthImage {
  std::size_t width = 0, height = 0;
  std::vector<float> xyz;             ///< of a pixel, row by row; NaN where nothing is within 5 m
  std::vector<std::uint8_t> is_robot; ///< one per pixel
};

/// A room with a table, and the robot in it, seen from its link `camera`: exact within 1 mm of noise, and
/// rounding.
/// @param width pixels; height is three quarters of it. 640: 307,200 points
DepthImage seenBy(const Robot& robot, const JointValues& values, std::size_t width = 640);

} // namespace pcl_bsh::self_filter
