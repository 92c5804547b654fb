// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/robot/robot.h>

#include <cmath>
#include <numbers>

namespace pcl_bsh::robots {

double Joint::way(double from, double to) const noexcept
{
  const double way = to - from;
  return kind == Kind::continuous ? std::remainder(way, 2.0 * std::numbers::pi) : way;
}

std::size_t Robot::linkNamed(const std::string& link) const
{
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].name == link) return i;
  throw InvalidInput(Input::scene, "link '" + link + "'",
                     "is not one of " + name + (links.empty() ? "" : ": its root is '" + links[0].name + "'"));
}

std::optional<std::size_t> Robot::linkOfJoint(const std::string& joint) const noexcept
{
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].joint && links[i].joint->name == joint) return i;
  return std::nullopt;
}

void Robot::requireValues(const JointValues& values) const
{
  for (const auto& [joint_name, value] : values) {
    const std::optional<std::size_t> link = linkOfJoint(joint_name);
    const std::string subject = "joint '" + joint_name + "'";
    if (!link) throw InvalidInput(Input::motion, subject, "is not one of " + name, "give a name that its URDF has");
    const Joint& joint = *links[*link].joint;
    if (joint.kind == Joint::Kind::fixed) throw InvalidInput(Input::motion, subject, "is fixed", "leave it out");
    if (joint.mimic)
      throw InvalidInput(Input::motion, subject, "mimics '" + joint.mimic->joint + "'", "give the value of that");
  }
}

std::vector<std::size_t> variablesOf(const Robot& robot)
{
  std::vector<std::size_t> variables;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const std::optional<Joint>& joint = robot.links[i].joint;
    if (joint && joint->kind != Joint::Kind::fixed && !joint->mimic) variables.push_back(i);
  }
  return variables;
}

RobotState stateOf(const Robot& robot, const JointValues& values)
{
  robot.requireValues(values);
  RobotState state;
  for (const std::size_t link : variablesOf(robot)) {
    const auto found = values.find(robot.links[link].joint->name);
    state.push_back(found == values.end() ? 0.0 : found->second);
  }
  return state;
}

} // namespace pcl_bsh::robots
