// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/path.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pcl_bsh {

Path::Path(const Leg& leg, const Box3& box)
: from_(leg.from),
  to_(leg.to),
  box_(box),
  center_(leg.center),
  world_center_(leg.from * leg.center),
  shift_(leg.to.translation() - leg.from.translation()),
  turns_(leg.turn != Eigen::Vector3d::Zero() || leg.from.linear() != leg.to.linear()),
  radius_(box.empty() ? 0.0 : (box.half().norm() + (box.center() - leg.center).norm()) * (1.0 + kDoubleMargin))
{
  if (!turns_) return;
  shift_ = to_ * center_ - world_center_;
  angle_ = leg.turn.norm();
  if (angle_ > 0.0) axis_ = leg.turn / angle_;
  drift_ = Eigen::AngleAxisd(-angle_, axis_).toRotationMatrix() * to_.linear() - from_.linear();
  drift_size_ = drift_.norm();
  constexpr double kNearlyRigid = 0x1p-19; // poses are rigid within 1e-6
  stretch_ = (1.0 + kNearlyRigid) * (1.0 + drift_size_);
}

Eigen::Isometry3d Path::at(double s) const
{
  if (s <= 0.0) return from_;
  if (s >= 1.0) return to_;
  Eigen::Isometry3d pose = from_;
  if (!turns_) {
    pose.translation() += s * shift_;
    return pose;
  }
  pose.linear() = Eigen::AngleAxisd(s * angle_, axis_).toRotationMatrix() * (from_.linear() + s * drift_);
  pose.translation() = world_center_ + s * shift_ - pose.linear() * center_;
  return pose;
}

double Path::turningReach(double length) const
{
  if (!turns_) return 0.0;
  const double chord = 2.0 * std::sin(0.5 * std::min(angle_ * length, std::numbers::pi));
  return (chord * stretch_ + drift_size_ * length) * radius_;
}

PointCourse Path::courseOf(const Eigen::Vector3d& point) const
{
  if (!turns_)
    return {from_ * point, shift_, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};
  const Eigen::Vector3d from_center = point - center_;
  return {world_center_, shift_, axis_, from_.linear() * from_center, drift_ * from_center, angle_};
}

Box3 Path::swept() const
{
  Box3 box = moved(box_, from_);
  box.merge(moved(box_, to_));
  if (turns_ && !box_.empty()) {
    Box3 ball{world_center_, world_center_};
    ball.merge({world_center_ + shift_, world_center_ + shift_});
    ball.grow(radius_ * stretch_ * (1.0 + kDoubleMargin) + rounding());
    box.merge(ball);
  }
  return box;
}

double Path::rounding() const
{
  if (box_.empty()) return 0.0;
  constexpr double kPlaceRounding = 64 * kDoubleUnit; // of some dozen operations on these lengths
  return kPlaceRounding * (from_.translation().norm() + to_.translation().norm() + center_.norm() + radius_ + speed());
}

Eigen::Isometry3d Leg::at(double s) const
{
  return Path(*this, Box3()).at(s);
}

} // namespace pcl_bsh
