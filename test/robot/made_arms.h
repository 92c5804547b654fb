// SPDX-License-Identifier: BSD-3-Clause
// Robots made at random, and where their points are, in long double.
#pragma once

#include "support/random.h"
#include <pcl_bsh/robot/kinematics.h>
#include <pcl_bsh/robot/shapes/shape.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::test {

using LongVector = Eigen::Matrix<long double, 3, 1>;
using LongMatrix = Eigen::Matrix<long double, 3, 3>;

inline Eigen::Vector3d madeVector(Random& random, double length)
{
  const double x = random.uniform(-length, length), y = random.uniform(-length, length),
               z = random.uniform(-length, length);
  return {x, y, z};
}

inline Eigen::Isometry3d madePose(Random& random, double away)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = madeVector(random, away);
  const Eigen::Vector3d axis = madeVector(random, 1.0).normalized();
  pose.linear() = Eigen::AngleAxisd(random.uniform(-3.0, 3.0), axis).toRotationMatrix();
  return pose;
}

inline robots::Shape madeShape(Random& random, bool only_spheres)
{
  robots::Shape shape;
  shape.pose = madePose(random, 0.1);
  const double r = random.uniform(0.02, 0.08), l = random.uniform(0.02, 0.2);
  switch (only_spheres ? 0 : random.integer(0, 3)) {
  case 0:
    shape.form = robots::Sphere{r};
    break;
  case 1:
    shape.form = robots::Capsule{r, l};
    break;
  case 2:
    shape.form = robots::Cylinder{r, l};
    break;
  default:
    shape.form = robots::Box{{r, l, 0.5 * (r + l)}};
  }
  return shape;
}

/// A tree of links with joints of all kinds.
inline robots::Robot madeArm(Random& random, std::size_t links, bool only_spheres)
{
  using robots::Joint;
  robots::Robot robot;
  robot.name = "made";
  for (std::size_t i = 0; i < links; ++i) {
    robots::Link link;
    link.name = "link" + std::to_string(i);
    for (int k = random.integer(0, 5); k > 0; --k) link.shapes.push_back(madeShape(random, only_spheres));
    if (i == 0) {
      robot.links.push_back(std::move(link));
      continue;
    }
    Joint joint;
    joint.name = "joint" + std::to_string(i);
    joint.parent = random.chance(0.8) ? i - 1 : static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1));
    joint.origin = madePose(random, 0.3);
    joint.axis = madeVector(random, 1.0).normalized();
    joint.kind = random.pick({Joint::Kind::revolute, Joint::Kind::revolute, Joint::Kind::continuous,
                              Joint::Kind::prismatic, Joint::Kind::fixed});
    if (joint.kind == Joint::Kind::revolute || joint.kind == Joint::Kind::prismatic) {
      const bool slides = joint.kind == Joint::Kind::prismatic;
      joint.lower = slides ? -0.2 : -2.5;
      joint.upper = slides ? 0.3 : 2.0;
    }
    const std::string before = "joint" + std::to_string(i - 1);
    if (i > 1 && joint.kind == Joint::Kind::revolute && robot.links[i - 1].joint->kind == Joint::Kind::revolute &&
        random.chance(0.2))
      joint.mimic = robots::Mimic{before, -0.5, 0.1};
    link.joint = joint;
    robot.links.push_back(std::move(link));
  }
  return robot;
}

inline robots::RobotState madeState(Random& random, const robots::Robot& robot)
{
  robots::RobotState state;
  for (const std::size_t link : variablesOf(robot)) {
    const robots::Joint& joint = *robot.links[link].joint;
    const bool any = joint.kind == robots::Joint::Kind::continuous;
    state.push_back(any ? random.uniform(-4.0, 4.0) : random.uniform(joint.lower, joint.upper));
  }
  return state;
}

struct LongPose {
  LongMatrix rotation = LongMatrix::Identity();
  LongVector translation = LongVector::Zero();
  LongVector operator*(const LongVector& x) const { return rotation * x + translation; }
};

/// Forward kinematics again, of the same bodies. Values of variables as given.
inline std::vector<LongPose> longPoses(const robots::Kinematics& kinematics, const std::vector<long double>& values)
{
  std::vector<LongPose> poses(1);
  for (std::size_t i = 1; i < kinematics.bodies().size(); ++i) {
    const robots::Kinematics::Body& body = kinematics.bodies()[i];
    const LongPose& parent = poses[body.parent];
    const auto value = static_cast<long double>(body.multiplier) * values[body.variable] + body.offset;
    const LongMatrix origin = body.origin.rotation.cast<long double>();
    const LongVector axis = body.axis.cast<long double>();
    LongMatrix k;
    k << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
    LongPose pose;
    const bool slides = body.kind == robots::Joint::Kind::prismatic;
    const LongMatrix turn =
        slides ? LongMatrix(LongMatrix::Identity())
               : LongMatrix(LongMatrix::Identity() + std::sin(value) * k + (1 - std::cos(value)) * (k * k));
    const LongVector slide = slides ? LongVector(value * axis) : LongVector(LongVector::Zero());
    pose.rotation = parent.rotation * origin * turn;
    pose.translation = parent * LongVector(body.origin.translation.cast<long double>() + origin * slide);
    poses.push_back(pose);
  }
  return poses;
}

/// The middle of a link's shape, at these poses of the bodies.
inline LongVector longCenter(const std::vector<LongPose>& poses, const robots::Kinematics& kinematics, std::size_t link,
                             const robots::Shape& shape)
{
  return poses[kinematics.bodyOf(link)] *
         LongVector((kinematics.inBody(link) * shape.pose).translation().cast<long double>());
}

/// The state at the fraction t of a motion; continuous joints go the shorter way.
inline std::vector<long double> longValues(const robots::Robot& robot, const robots::RobotState& from,
                                           const robots::RobotState& to, long double t)
{
  const std::vector<std::size_t> variables = variablesOf(robot);
  std::vector<long double> values;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    long double way = static_cast<long double>(to[i]) - from[i];
    if (robot.links[variables[i]].joint->kind == robots::Joint::Kind::continuous)
      way = std::remainder(way, 2 * std::acos(-1.0L));
    values.push_back(from[i] + t * way);
  }
  return values;
}

} // namespace pcl_bsh::test
