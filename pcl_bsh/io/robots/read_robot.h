// SPDX-License-Identifier: BSD-3-Clause
// Robots from files. A URDF has links, joints and shapes. An SRDF has pairs of links that are never compared.
#pragma once

#include <pcl_bsh/robot/robot.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Reads a URDF: its joints, and the collision bodies of each link. A link without collision bodies has its visual
/// bodies. Joints are fixed, revolute, continuous or prismatic.
/// @param packages where `package://NAME/...` leads: the folder of each package
/// @param package_path folders where other packages are looked for, as ROS_PACKAGE_PATH has them (ros_packages.h)
/// @throws files::FileError where it cannot be read, is no tree of such joints, or names a mesh that is not there
robots::Robot readRobot(const std::filesystem::path& urdf,
                        const std::map<std::string, std::filesystem::path>& packages = {},
                        const std::string& package_path = {});

/// Reads the surfaces of its meshes, scaled. @throws files::FileError as readSurface() does; for a mesh without faces
void readMeshes(robots::Robot& robot);

/// Groups and states of an SRDF.
struct RobotGroups {
  std::map<std::string, std::vector<std::string>> joints; ///< of each group, by its name: those that move
  std::map<std::string, robots::JointValues> states;      ///< by their names
};

/// Adds the pairs of links that are disabled to the robot. Names that the robot has not are left out.
/// @throws files::FileError where it cannot be read, or is no SRDF
RobotGroups readGroups(const std::filesystem::path& srdf, robots::Robot& robot);

} // namespace pcl_bsh::io
