// SPDX-License-Identifier: BSD-3-Clause
// A robot as a tree of links, and where they are when its joints have some values.
//
//   Robot arm = io::readRobot("arm.urdf");             // pcl_bsh/io/robots; or made by hand
//   Kinematics kinematics(arm);                        // checks it
//   RobotState state = stateOf(arm, {{"elbow", 0.7}}); // one value for each of variablesOf(arm)
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::robots {
/// A ball about the origin.
struct Sphere {
  double radius = 0.0; ///< m, > 0
};
/// All within a radius of a segment.
struct Capsule {
  double radius = 0.0, length = 0.0; ///< m, > 0; about z, centred; the length is that between the ends' centres
};
/// A cylinder with flat ends.
struct Cylinder {
  double radius = 0.0, length = 0.0; ///< m, > 0; about z, centred
};
/// A box along the axes.
struct Box {
  Eigen::Vector3d size = Eigen::Vector3d::Zero(); ///< m; all three > 0; centred
};

/// Triangles that a file has.
struct Mesh {
  std::string path;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  std::shared_ptr<const SphereHierarchy> surface = nullptr; ///< of triangles, scaled; null until it is read
};

/// A body of a link, solid unless it is a mesh.
struct Shape {
  std::variant<Box, Cylinder, Sphere, Mesh, Capsule> form;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_link_shape
};

/// A joint that mimics another has the value multiplier * (value of that) + offset.
struct Mimic {
  std::string joint;
  double multiplier = 1.0, offset = 0.0;
};

/// How a link hangs on its parent. A continuous joint goes the shorter way.
struct Joint {
  /** As URDF has them. */ enum class Kind : std::uint8_t { fixed, revolute, continuous, prismatic };
  /// Whether it turns about its axis.
  bool turns() const noexcept { return kind == Kind::revolute || kind == Kind::continuous; }
  /// How far its value goes from one to another on a line in joint space.
  double way(double from, double to) const noexcept;

  std::string name;
  Kind kind = Kind::fixed;
  std::size_t parent = 0;                                   ///< its link
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity(); ///< T_parent_link where the joint's value is 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();          ///< of length 1, in the link's frame
  std::optional<Mimic> mimic = {};
  double lower = -std::numeric_limits<double>::infinity(); ///< rad or m; of a continuous joint no matter
  double upper = std::numeric_limits<double>::infinity();
};
/// A rigid part of a robot, with the joint that moves it.
struct Link {
  std::string name;
  std::vector<Shape> shapes;
  std::optional<Joint> joint; ///< none: the root
  double padding = 0.0;       ///< m, >= 0: the link is as thick as if its shapes were so much larger all round
};

/// In radians or metres, by the names of joints; those that are not named are at 0.
using JointValues = std::map<std::string, double>;

/// One value for each of variablesOf().
using RobotState = std::vector<double>;
/// Links and joints, as files have them.
struct Robot {
  std::string name;
  std::vector<Link> links; ///< parents before their children; the first is the root

  /// Pairs of links that are never held against each other. Nor are a link and its parent.
  std::vector<std::array<std::size_t, 2>> disabled_pairs = {};

  /// @throws InvalidInput naming the link that is not there
  std::size_t linkNamed(const std::string& link) const;

  /// The link that a joint moves, if there is such a joint.
  std::optional<std::size_t> linkOfJoint(const std::string& joint) const noexcept;

  /// @throws InvalidInput naming a joint that is not there, does not move, or mimics another
  void requireValues(const JointValues& values) const;
};

/// Returns the nearest rigid pose to one that was given with few digits: robots and worlds take poses that are rigid
/// within 1e-12.
inline Eigen::Isometry3d rigidPose(Eigen::Isometry3d pose)
{
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

/// The links whose joints have values of their own, in the order of links: neither fixed joints nor those that mimic.
std::vector<std::size_t> variablesOf(const Robot& robot);

/// @throws InvalidInput as Robot::requireValues() does
RobotState stateOf(const Robot& robot, const JointValues& values);

} // namespace pcl_bsh::robots
PCL_BSH_EXPORT_END
