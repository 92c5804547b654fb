// SPDX-License-Identifier: BSD-3-Clause
// A robot as a tree of links, and where they are when its joints have some values.
#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pcl_bsh::self_filter {

struct Box {
  Eigen::Vector3d size; ///< m; all three > 0
};

struct Cylinder {
  double radius = 0.0, length = 0.0; ///< m, > 0; about z, centred
};

struct Sphere {
  double radius = 0.0; ///< m, > 0
};

struct MeshFile {
  std::filesystem::path path;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

/// A body of a link.
struct Shape {
  std::variant<Box, Cylinder, Sphere, MeshFile> form;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_link_shape
};

/// A joint that mimics another has the value multiplier * (value of that) + offset.
struct Mimic {
  std::string joint;
  double multiplier = 1.0, offset = 0.0;
};

/// How a link hangs on its parent.
struct Joint {
  enum class Kind { fixed, turning, sliding };

  std::string name;
  Kind kind = Kind::fixed;
  std::size_t parent = 0;                                   ///< its link
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity(); ///< T_parent_link where the joint's value is 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();          ///< of length 1, in the link's frame
  std::optional<Mimic> mimic;
};

struct Link {
  std::string name;
  std::vector<Shape> shapes;
  std::optional<Joint> joint; ///< none: the root
};

/// In radians or metres, by the names of joints; those that are not named are at 0.
using JointValues = std::map<std::string, double>;

struct Robot {
  std::string name;
  std::vector<Link> links; ///< parents before their children; the first is the root

  /// @throws std::runtime_error naming the link that is not there
  std::size_t linkNamed(const std::string& link) const;

  /// @throws std::runtime_error naming a joint that is not there, does not move, or mimics another
  void requireValues(const JointValues& values) const;

  /// T_root_link of every link. @pre requireValues()
  std::vector<Eigen::Isometry3d> poses(const JointValues& values) const;

private:
  double valueOf(const Joint& joint, const JointValues& values) const;
  const Joint* jointNamed(const std::string& joint) const;
};

/// Reads a URDF: its joints and, of each link, the bodies for collisions or, where there are none, those to look at.
/// Joints are fixed, revolute, continuous or prismatic.
/// @param packages where `package://NAME/...` leads: the folder of each package
/// @param package_path where the others are looked for: folders as ROS_PACKAGE_PATH has them (ros_packages.h)
/// @throws files::FileError where it cannot be read, is no tree of such joints, or names a mesh that is not there
Robot readRobot(const std::filesystem::path& urdf, const std::map<std::string, std::filesystem::path>& packages = {},
                const std::string& package_path = {});

} // namespace pcl_bsh::self_filter
