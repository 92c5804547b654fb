// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/robot/kinematics.h>
#include <pcl_bsh/robot/outward.h>
#include <pcl_bsh/robot/shapes/shape.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl_bsh::robots {

namespace {

constexpr double kUnit = 0x1p-53;

[[noreturn]] void refuse(const std::string& subject, const std::string& wrong, const std::string& remedy)
{
  throw InvalidInput(Input::scene, subject, wrong, remedy);
}

void requireRigid(const Eigen::Isometry3d& pose, const std::string& subject)
{
  if (!isRigid(pose, kRigid))
    refuse(subject, "has a pose that is not rigid", "give a rotation and a finite translation");
}

void requireShapes(const Link& link)
{
  const std::string subject = "link '" + link.name + "'";
  if (!(link.padding >= 0.0 && std::isfinite(link.padding)))
    refuse(subject, "has the padding " + std::to_string(link.padding), "give one that is finite and >= 0");
  for (const Shape& shape : link.shapes) {
    requireRigid(shape.pose, subject);
    const std::optional<Solid> solid = solidOf(shape);
    if (!solid) continue;
    for (const double size : sizesOf(*solid))
      if (!(size > 0.0 && size <= 1e30))
        refuse(subject, "has a shape of size " + std::to_string(size), "give one above 0, and at most 1e30 m");
  }
}

void requireJoint(const Joint& joint, std::size_t link)
{
  const std::string subject = "joint '" + joint.name + "'";
  if (joint.parent >= link) refuse(subject, "has a parent that comes after its child", "order links from the root on");
  requireRigid(joint.origin, subject);
  if (joint.kind == Joint::Kind::fixed) return;
  if (!(std::abs(joint.axis.norm() - 1.0) <= kRigid)) refuse(subject, "has an axis not of length 1", "normalise it");
  if (joint.kind == Joint::Kind::continuous) return;
  if (!(joint.lower <= joint.upper))
    refuse(subject, "has limits " + std::to_string(joint.lower) + " to " + std::to_string(joint.upper),
           "let the lower one come first");
  if (joint.kind == Joint::Kind::prismatic && !(std::isfinite(joint.lower) && std::isfinite(joint.upper)))
    refuse(subject, "slides without limits", "give it finite ones");
}

/// A joint's value as multiplier * v + offset, v being the value of the link's joint, which mimics no other.
struct Source {
  std::size_t link = 0;
  double multiplier = 1.0, offset = 0.0;
};

Source sourceOf(const Robot& robot, std::size_t link)
{
  Source source{link};
  for (std::size_t steps = 0; robot.links[source.link].joint->mimic; ++steps) {
    const Joint& joint = *robot.links[source.link].joint;
    const std::optional<std::size_t> next = robot.linkOfJoint(joint.mimic->joint);
    const std::string subject = "joint '" + joint.name + "'";
    if (!next || robot.links[*next].joint->kind == Joint::Kind::fixed)
      refuse(subject, "mimics '" + joint.mimic->joint + "', which is not there, or fixed", "mend the name");
    if (steps > robot.links.size()) refuse(subject, "mimics itself", "let one of them have its own value");
    if (!(std::isfinite(joint.mimic->multiplier) && std::isfinite(joint.mimic->offset)))
      refuse(subject, "mimics by numbers that are not finite", "give a multiplier and an offset");
    source.offset += source.multiplier * joint.mimic->offset;
    source.multiplier *= joint.mimic->multiplier;
    source.link = *next;
  }
  return source;
}

Eigen::Matrix3d crossed(const Eigen::Vector3d& a)
{
  Eigen::Matrix3d k;
  k << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return k;
}

double valueOf(const Kinematics::Body& body, const RobotState& state)
{
  return body.multiplier * state[body.variable] + body.offset;
}

} // namespace

Kinematics::Kinematics(const Robot& robot) : bodies_(1)
{
  if (robot.links.empty()) refuse("robot '" + robot.name + "'", "has no link", "give it a root");
  std::vector<std::size_t> variable_of_link(robot.links.size()), depths = {0};
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    requireShapes(robot.links[i]);
    const std::optional<Joint>& joint = robot.links[i].joint;
    if (joint.has_value() == (i == 0))
      refuse("link '" + robot.links[i].name + "'", i == 0 ? "is the first, and hangs on a joint" : "hangs on no joint",
             "let all but the first hang on one");
    if (joint) requireJoint(*joint, i);
    if (!joint || joint->kind == Joint::Kind::fixed || joint->mimic) continue;
    variable_of_link[i] = links_of_variables_.size();
    links_of_variables_.push_back(i);
  }
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (i == 0) {
      body_of_link_.push_back(0);
      T_body_link_.push_back(Eigen::Isometry3d::Identity());
      continue;
    }
    const Joint& joint = *robot.links[i].joint;
    const std::size_t parent = body_of_link_[joint.parent];
    const Eigen::Isometry3d origin = T_body_link_[joint.parent] * joint.origin;
    if (joint.kind == Joint::Kind::fixed) {
      body_of_link_.push_back(parent);
      T_body_link_.push_back(origin);
      continue;
    }
    const Source source = sourceOf(robot, i);
    const Eigen::Matrix3d k = crossed(joint.axis);
    Body body;
    body.link = i;
    body.parent = parent;
    body.variable = variable_of_link[source.link];
    body.multiplier = source.multiplier;
    body.offset = source.offset;
    body.kind = joint.kind;
    body.origin = {origin.linear(), origin.translation()};
    body.sine = body.origin.rotation * k;
    body.versine = body.sine * k;
    body.axis = joint.axis;
    body.origin_axis = body.origin.rotation * joint.axis;
    body.reach = bodies_[parent].reach + body.origin.translation.norm();
    if (joint.kind == Joint::Kind::prismatic) {
      body.lower = joint.lower;
      body.upper = joint.upper;
      body.reach += std::max(std::abs(joint.lower), std::abs(joint.upper));
    }
    body_of_link_.push_back(bodies_.size());
    T_body_link_.push_back(Eigen::Isometry3d::Identity());
    depths.push_back(depths[parent] + 1);
    depth_ = std::max(depth_, depths.back());
    bodies_.push_back(body);
  }
}

void Kinematics::poses(const RobotState& state, const Pose& base, std::size_t count, std::vector<Pose>& poses) const
{
  poses.resize(std::max(poses.size(), count));
  poses[0] = base;
  for (std::size_t i = 1; i < count; ++i) {
    const Body& body = bodies_[i];
    const Pose& parent = poses[body.parent];
    const double value = valueOf(body, state);
    if (body.kind == Joint::Kind::prismatic) {
      poses[i].rotation.noalias() = parent.rotation * body.origin.rotation;
      poses[i].translation =
          parent.translation + parent.rotation * (body.origin.translation + value * body.origin_axis);
      continue;
    }
    const Eigen::Matrix3d turned =
        body.origin.rotation + std::sin(value) * body.sine + (1.0 - std::cos(value)) * body.versine;
    poses[i].rotation.noalias() = parent.rotation * turned;
    poses[i].translation = parent.translation;
    poses[i].translation.noalias() += parent.rotation * body.origin.translation;
  }
}

std::vector<Eigen::Isometry3d> Kinematics::linkPoses(const RobotState& state) const
{
  std::vector<Pose> of_bodies;
  poses(state, {}, bodies_.size(), of_bodies);
  std::vector<Eigen::Isometry3d> of_links;
  for (std::size_t i = 0; i < body_of_link_.size(); ++i)
    of_links.push_back(of_bodies[body_of_link_[i]].isometry() * T_body_link_[i]);
  return of_links;
}

void Kinematics::twists(const RobotState& slopes, const std::vector<Pose>& poses, std::size_t count,
                        std::vector<Twist>& twists) const
{
  twists.resize(std::max(twists.size(), count));
  twists[0] = {};
  for (std::size_t i = 1; i < count; ++i) {
    const Body& body = bodies_[i];
    const double slope = body.multiplier * slopes[body.variable];
    const Eigen::Vector3d along = poses[body.parent].rotation * (slope * body.origin_axis);
    twists[i] = twists[body.parent];
    if (body.kind == Joint::Kind::prismatic) {
      twists[i].shift += along;
      continue;
    }
    twists[i].turn += along;
    twists[i].shift -= along.cross(poses[i].translation);
  }
}

std::vector<std::size_t> Kinematics::chain(std::size_t body) const
{
  std::vector<std::size_t> chain;
  for (; body != 0; body = bodies_[body].parent) chain.push_back(body);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

std::vector<double> Kinematics::axisDistances(std::size_t of, const Eigen::Vector3d& center, double spread) const
{
  const std::vector<std::size_t> bodies = chain(of);
  std::vector<double> distances(bodies.size(), 1.0);
  Eigen::Vector3d ends[2] = {center, center}, direction = Eigen::Vector3d::Zero(); // of a cylinder in the body's frame
  double radius = spread;
  for (std::size_t i = bodies.size(); i-- > 0;) {
    const Body& body = bodies_[bodies[i]];
    const double middle[2] = {body.axis.dot(ends[0]), body.axis.dot(ends[1])};
    const double tilt = direction.isZero(0.0) ? radius : radius * body.axis.cross(direction).norm();
    double low = std::min(middle[0], middle[1]) - tilt, high = std::max(middle[0], middle[1]) + tilt;
    if (body.kind == Joint::Kind::prismatic) {
      // It does not turn what it carries: a ball holds all of that, and moves between the limits.
      const Eigen::Vector3d mean = 0.5 * (ends[0] + ends[1]);
      radius = (ends[0] - mean).norm() + radius;
      ends[0] = mean + body.lower * body.axis;
      ends[1] = mean + body.upper * body.axis;
      low = high = 0.0;
      direction.setZero();
    }
    else {
      double across = 0.0;
      for (const Eigen::Vector3d& end : ends)
        across = std::max(across, (end - body.axis.dot(end) * body.axis).norm() + radius);
      radius = distances[i] = kOutward * across;
      ends[0] = low * body.axis;
      ends[1] = high * body.axis;
      direction = body.axis;
    }
    for (Eigen::Vector3d& end : ends) end = body.origin * end;
    direction = body.origin.rotation * direction;
  }
  return distances;
}

double Kinematics::error(const RobotState& largest, double extent, double base) const
{
  double reach = base, turns = 0.0;
  for (const Body& body : bodies_) reach = std::max(reach, base + body.reach);
  reach += extent;
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const double value = std::abs(body.multiplier) * largest[body.variable] + 2.0 * std::abs(body.offset);
    turns += value * (body.kind == Joint::Kind::prismatic ? 1.0 : reach);
  }
  return kOutward * kUnit * (kForwardRoundings * static_cast<double>(depth_ + 1) * reach + 32.0 * turns);
}

std::vector<Eigen::Isometry3d> linkPoses(const Robot& robot, const JointValues& values)
{
  return Kinematics(robot).linkPoses(stateOf(robot, values));
}

std::vector<std::array<std::size_t, 2>> comparedLinks(const Robot& robot, const Kinematics& kinematics)
{
  const std::size_t count = robot.links.size();
  std::vector<bool> compared(count * count, true);
  const auto leaveOut = [&](std::size_t a, std::size_t b) {
    compared[a * count + b] = compared[b * count + a] = false;
  };
  for (const auto& [a, b] : robot.disabled_pairs) {
    if (a >= count || b >= count)
      throw InvalidInput(Input::scene, "robot '" + robot.name + "'", "disables a pair of links that it has not",
                         "name links by their numbers");
    leaveOut(a, b);
  }
  for (std::size_t i = 1; i < count; ++i) leaveOut(i, robot.links[i].joint->parent);
  std::vector<std::array<std::size_t, 2>> pairs;
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b)
      if (compared[a * count + b] && kinematics.bodyOf(a) != kinematics.bodyOf(b)) pairs.push_back({a, b});
  return pairs;
}

} // namespace pcl_bsh::robots
