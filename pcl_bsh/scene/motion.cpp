// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/motion.h>

#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/scene/path.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace pcl_bsh {
namespace {

Eigen::Matrix3d turn(const Eigen::Vector3d& axis_times_angle)
{
  const double angle = axis_times_angle.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, axis_times_angle / angle).toRotationMatrix();
}

struct At {
  const Eigen::Isometry3d& start;
  double time;

  Eigen::Isometry3d operator()(const NoMotion&) const { return start; }

  Eigen::Isometry3d operator()(const VelocityMotion& motion) const
  {
    Eigen::Isometry3d pose = start;
    pose.translation() += time * motion.linear;
    pose.linear() = turn(time * motion.angular) * start.linear();
    return pose;
  }

  Eigen::Isometry3d operator()(const CircularMotion& motion) const
  {
    const Eigen::Matrix3d rotation = turn(time * motion.speed * motion.axis.normalized());
    Eigen::Isometry3d pose = start;
    pose.translation() = motion.center + rotation * (start.translation() - motion.center);
    if (motion.turning) pose.linear() = rotation * start.linear();
    return pose;
  }

  Eigen::Isometry3d operator()(const WaypointMotion& motion) const
  {
    const auto after = std::upper_bound(motion.times.begin(), motion.times.end(), time) - motion.times.begin();
    if (after == 0) return motion.poses.front();
    const auto i = static_cast<std::size_t>(after);
    if (i == motion.times.size() || motion.times[i - 1] == time) return motion.poses[i - 1];
    const Eigen::Isometry3d &from = motion.poses[i - 1], &to = motion.poses[i];
    const double s = (time - motion.times[i - 1]) / (motion.times[i] - motion.times[i - 1]);
    Eigen::Isometry3d pose = from;
    pose.translation() += s * (to.translation() - from.translation());
    if (from.linear() != to.linear()) {
      const Eigen::Quaterniond q(from.linear()), r(to.linear());
      pose.linear() = q.slerp(s, r).normalized().toRotationMatrix();
    }
    return pose;
  }
};

/// The shorter turn from one rotation to another.
Eigen::Vector3d turnTo(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to)
{
  if (from == to) return Eigen::Vector3d::Zero();
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(to * from.transpose()).normalized());
  return turn.angle() * turn.axis();
}

struct Turn {
  double from, to;

  Eigen::Vector3d operator()(const NoMotion&) const { return Eigen::Vector3d::Zero(); }
  Eigen::Vector3d operator()(const VelocityMotion& motion) const { return (to - from) * motion.angular; }

  Eigen::Vector3d operator()(const CircularMotion& motion) const
  {
    if (!motion.turning) return Eigen::Vector3d::Zero();
    return (to - from) * motion.speed * motion.axis.normalized();
  }

  Eigen::Vector3d operator()(const WaypointMotion& motion) const
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const std::vector<double>& times = motion.times;
    const auto after = std::upper_bound(times.begin(), times.end(), from) - times.begin();
    for (auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after, 1)); i < times.size(); ++i) {
      if (times[i - 1] >= to) break;
      const double part = (std::min(to, times[i]) - std::max(from, times[i - 1])) / (times[i] - times[i - 1]);
      sum += part * turnTo(motion.poses[i - 1].linear(), motion.poses[i].linear());
    }
    return sum;
  }
};

struct Check {
  void operator()(const NoMotion&) const {}

  void operator()(const VelocityMotion& motion) const
  {
    if (!motion.linear.allFinite() || !motion.angular.allFinite()) fail("a velocity is not finite");
  }

  void operator()(const CircularMotion& motion) const
  {
    if (!motion.center.allFinite() || !std::isfinite(motion.speed)) fail("a circle's centre or speed is not finite");
    if (!(motion.axis.allFinite() && motion.axis.norm() > 0.0)) fail("a circle's axis is not finite or of length 0");
  }

  void operator()(const WaypointMotion& motion) const
  {
    if (motion.poses.empty()) fail("waypoints without a pose");
    if (motion.poses.size() != motion.times.size())
      fail(std::to_string(motion.poses.size()) + " waypoints for " + std::to_string(motion.times.size()) + " times");
    for (std::size_t i = 0; i < motion.times.size(); ++i)
      if (!std::isfinite(motion.times[i]) || (i > 0 && motion.times[i] <= motion.times[i - 1]))
        fail("time " + std::to_string(motion.times[i]) + " of waypoint " + std::to_string(i) + " does not ascend");
    for (std::size_t i = 0; i < motion.poses.size(); ++i) checkPose("waypoint " + std::to_string(i), motion.poses[i]);
  }

  [[noreturn]] static void fail(const std::string& what) { throw InvalidInput(Input::motion, "motion", what); }
};

} // namespace

Eigen::Isometry3d poseAt(const Motion& motion, const Eigen::Isometry3d& start, double time)
{
  return std::visit(At{start, time}, motion);
}

Eigen::Vector3d turnOf(const Motion& motion, double from, double to)
{
  return std::visit(Turn{from, to}, motion);
}

Eigen::Vector3d turnBetween(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to, const Eigen::Vector3d& asked)
{
  const Eigen::Vector3d shorter = turnTo(from, to);
  const double length = asked.norm();
  if (length == 0.0) return shorter;
  const Eigen::AngleAxisd all(length, asked / length);
  // Rounding of long turns is the path's affair: it arrives at the pose given.
  if (turnTo(all.toRotationMatrix() * from, to).norm() <= 1e-6) return asked;
  // Something else turned it as well. Of all turns that arrive, the one nearest to what was asked for: full turns more
  // or less about the axis of the shorter one, which noise alone decides where that is next to nothing.
  constexpr double full = 2.0 * std::numbers::pi;
  const double angle = shorter.norm();
  if (angle <= 1e-9) return full * std::round(length / full) * all.axis();
  const Eigen::Vector3d axis = shorter / angle;
  return (angle + full * std::round((asked.dot(axis) - angle) / full)) * axis;
}

void check(const Motion& motion)
{
  std::visit(Check{}, motion);
}

} // namespace pcl_bsh
