// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/motion.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/polar_decomposition.h>
#include <pcl_bsh/geometry/rigid_motion.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pcl_bsh {
namespace {

Eigen::Isometry3d nearestRigid(Eigen::Isometry3d pose)
{
  pose.linear() = PolarDecomposition(pose.linear()).rotation;
  return pose;
}

struct At {
  const Eigen::Isometry3d& start;
  double time;

  Eigen::Isometry3d operator()(const NoMotion&) const { return start; }

  Eigen::Isometry3d operator()(const VelocityMotion& motion) const
  {
    Eigen::Isometry3d pose = start;
    pose.translation() += time * motion.linear;
    pose.linear() = rotationBy(time * motion.angular) * start.linear();
    return pose;
  }

  Eigen::Isometry3d operator()(const CircularMotion& motion) const
  {
    const Eigen::Matrix3d rotation = rotationBy(time * motion.speed * motion.axis.normalized());
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
    // Rotations are made rigid within rounding: between waypoints that are just rigid enough, the pose of a part in the
    // world might not be.
    const Eigen::Isometry3d from = nearestRigid(motion.poses[i - 1]), to = nearestRigid(motion.poses[i]);
    const Eigen::Vector3d turn = shorterTurnOfRotations(from.linear(), to.linear());
    const double s = (time - motion.times[i - 1]) / (motion.times[i] - motion.times[i - 1]);
    return RigidMotion(from, to, Eigen::Vector3d::Zero(), turn).at(s);
  }
};

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
      sum += part * shorterTurn(motion.poses[i - 1].linear(), motion.poses[i].linear());
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
      fail(counted(motion.poses.size(), "waypoint") + " for " + counted(motion.times.size(), "time"));
    for (std::size_t i = 0; i < motion.times.size(); ++i)
      if (!std::isfinite(motion.times[i]) || (i > 0 && motion.times[i] <= motion.times[i - 1]))
        fail("time " + plainText(motion.times[i]) + " of waypoint " + plainText(i) + " does not ascend");
    for (std::size_t i = 0; i < motion.poses.size(); ++i) checkPose("waypoint " + plainText(i), motion.poses[i]);
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

Eigen::Isometry3d Leg::at(double s) const
{
  return RigidMotion(from, to, center, turn).at(s);
}

void check(const Motion& motion)
{
  std::visit(Check{}, motion);
}

} // namespace pcl_bsh
