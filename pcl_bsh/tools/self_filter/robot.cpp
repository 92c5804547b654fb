// SPDX-License-Identifier: BSD-3-Clause
#include "robot.h"

#include <stdexcept>

namespace pcl_bsh::self_filter {

std::size_t Robot::linkNamed(const std::string& link) const
{
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].name == link) return i;
  throw std::runtime_error("link '" + link + "': is not one of " + name + ": its root is '" + links[0].name + "'");
}

const Joint* Robot::jointNamed(const std::string& joint) const
{
  for (const Link& link : links)
    if (link.joint && link.joint->name == joint) return &*link.joint;
  return nullptr;
}

void Robot::requireValues(const JointValues& values) const
{
  for (const auto& [joint_name, value] : values) {
    const Joint* joint = jointNamed(joint_name);
    const std::string subject = "joint '" + joint_name + "': ";
    if (!joint) throw std::runtime_error(subject + "is not one of " + name + ": give a name that its URDF has");
    if (joint->kind == Joint::Kind::fixed) throw std::runtime_error(subject + "is fixed: leave it out");
    if (joint->mimic)
      throw std::runtime_error(subject + "mimics '" + joint->mimic->joint + "': give the value of that");
  }
}

double Robot::valueOf(const Joint& joint, const JointValues& values) const
{
  if (joint.mimic)
    return joint.mimic->multiplier * valueOf(*jointNamed(joint.mimic->joint), values) + joint.mimic->offset;
  const auto found = values.find(joint.name);
  return found == values.end() ? 0.0 : found->second;
}

std::vector<Eigen::Isometry3d> Robot::poses(const JointValues& values) const
{
  std::vector<Eigen::Isometry3d> poses;
  for (const Link& link : links) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (link.joint) {
      pose = poses[link.joint->parent] * link.joint->origin;
      if (link.joint->kind == Joint::Kind::turning)
        pose.rotate(Eigen::AngleAxisd(valueOf(*link.joint, values), link.joint->axis));
      if (link.joint->kind == Joint::Kind::sliding) pose.translate(valueOf(*link.joint, values) * link.joint->axis);
    }
    poses.push_back(pose);
  }
  return poses;
}

} // namespace pcl_bsh::self_filter
