// SPDX-License-Identifier: BSD-3-Clause
#include "separation_monitor.h"

#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/robot/swept_region.h>

#include <algorithm>
#include <cstring>
#include <optional>

namespace pcl_bsh::self_filter {

namespace {

Robot withMeshes(Robot robot)
{
  io::readMeshes(robot);
  return robot;
}

JointValues valuesOf(const robots::RobotWorld& world, const robots::RobotState& state)
{
  JointValues values;
  for (std::size_t i = 0; i < state.size(); ++i)
    values[world.robot().links[world.kinematics().linkOfVariable(i)].joint->name] = state[i];
  return values;
}

/// The distance from the motion beyond which no point of the frame matters, m.
double marginOf(const PointsView& frame, double padding, double clearance)
{
  double radius = 0.0, own = 0.0;
  for (std::size_t i = 0; i < frame.size() && (frame.radii || frame.uncertainties); ++i) {
    radius = std::max(radius, frame.ownRadius(frame.record(i)));
    own = std::max(own, frame.ownUncertainty(frame.record(i)));
  }
  return std::max(padding, clearance) + radius + own + frame.uncertainty;
}

} // namespace

PointsView NearPoints::take(const PointsView& frame, const std::vector<std::int32_t>& records)
{
  const std::size_t size = frame.scalar == Scalar::float32 ? sizeof(float) : sizeof(double);
  coordinates_.resize(3 * size * records.size());
  radii_.clear();
  uncertainties_.clear();
  unsigned char* to = coordinates_.data();
  for (const std::int32_t number : records) {
    const auto record = static_cast<std::size_t>(number);
    for (const std::size_t offset : frame.offset) {
      std::memcpy(to, static_cast<const unsigned char*>(frame.data) + frame.stride * record + offset, size);
      to += size;
    }
    if (frame.radii) radii_.push_back(frame.radii[record]);
    if (frame.uncertainties) uncertainties_.push_back(frame.uncertainties[record]);
  }
  PointsView view = frame;
  view.data = coordinates_.data();
  view.count = records.size();
  view.stride = 3 * size;
  view.offset = {0, size, 2 * size};
  view.indices = nullptr;
  if (frame.radii) view.radii = radii_.data();
  if (frame.uncertainties) view.uncertainties = uncertainties_.data();
  return view;
}

SeparationMonitor::SeparationMonitor(const Robot& robot, const Settings& filter, const robots::WorldOptions& options)
: filter_(robot, filter),
  world_(withMeshes(robot), {}, options)
{
}

SeparationCheck SeparationMonitor::check(const PointsView& frame, const Eigen::Isometry3d& T_world_camera,
                                         const robots::RobotState& now, const robots::RobotState& next)
{
  const double margin = marginOf(frame, filter_.greatestPadding(), world_.options().clearance);
  robots::SweptRegion(world_.sweptBalls(now, next), margin, T_world_camera).recordsInside(frame, records_);
  const Eigen::Isometry3d rigid = robots::rigidPose(T_world_camera);

  SeparationCheck check;
  check.near = records_.size();
  PointsView points = near_.take(frame, records_);
  const Eigen::Isometry3d T_camera_root = rigid.inverse() * world_.options().base;
  const std::vector<Verdict>& flags = filter_.flags(points, T_camera_root, valuesOf(world_, now));
  others_.clear();
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i] == Verdict::free) others_.push_back(static_cast<std::int32_t>(i));
  check.self = records_.size() - others_.size();

  points.restrictTo(others_.data(), others_.size());
  auto obstacle = std::make_unique<const SphereHierarchy>(points);
  world_.setObstacles({obstacle.get()}, {rigid});
  obstacle_ = std::move(obstacle);
  check.motion = world_.checkMotion(now, next, true);
  if (std::optional<robots::Meeting>& meeting = check.motion.meeting; meeting && !meeting->other_link)
    meeting->record = static_cast<std::uint32_t>(records_[meeting->record]);
  return check;
}

} // namespace pcl_bsh::self_filter
