// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/rigid_motion.h>

#include <pcl_bsh/geometry/polar_decomposition.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pcl_bsh {

RigidMotion::RigidMotion(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, const Eigen::Vector3d& pivot,
                         const Eigen::Vector3d& turn)
: from_(from),
  to_(to),
  pivot_(pivot),
  world_pivot_(from * pivot),
  shift_(to.translation() - from.translation()),
  turns_(turn != Eigen::Vector3d::Zero() || from.linear() != to.linear())
{
  if (!turns_) return;
  shift_ = to_ * pivot_ - world_pivot_;
  angle_ = turn.norm();
  if (angle_ > 0.0) axis_ = turn / angle_;
  drift_ = Eigen::AngleAxisd(-angle_, axis_).toRotationMatrix() * to_.linear() - from_.linear();
  drift_size_ = drift_.norm();
  constexpr double kNearlyRigid = 0x1p-19; // poses are rigid within 1e-6
  stretch_ = (1.0 + kNearlyRigid) * (1.0 + drift_size_);
}

Eigen::Isometry3d RigidMotion::at(double s) const
{
  if (s <= 0.0) return from_;
  if (s >= 1.0) return to_;
  Eigen::Isometry3d pose = from_;
  if (!turns_) {
    pose.translation() += s * shift_;
    return pose;
  }
  pose.linear() = Eigen::AngleAxisd(s * angle_, axis_).toRotationMatrix() * (from_.linear() + s * drift_);
  pose.translation() = world_pivot_ + s * shift_ - pose.linear() * pivot_;
  return pose;
}

PointMotion RigidMotion::motionOf(const Eigen::Vector3d& point) const
{
  if (!turns_)
    return {from_ * point, shift_, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0};
  const Eigen::Vector3d from_pivot = point - pivot_;
  return {world_pivot_, shift_, axis_, from_.linear() * from_pivot, drift_ * from_pivot, angle_};
}

double RigidMotion::turningSpeed(double radius) const
{
  return turns_ ? (angle_ * stretch_ + drift_size_) * radius : 0.0;
}

double RigidMotion::turningReach(double radius, double length) const
{
  if (!turns_) return 0.0;
  const double chord = 2.0 * std::sin(0.5 * std::min(angle_ * length, std::numbers::pi));
  return (chord * stretch_ + drift_size_ * length) * radius;
}

Eigen::Matrix3d rotationBy(const Eigen::Vector3d& turn)
{
  const double angle = turn.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

Eigen::Vector3d shorterTurnOfRotations(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to)
{
  if (from == to) return Eigen::Vector3d::Zero();
  const Eigen::Quaterniond first = Eigen::Quaterniond(from).normalized(), last = Eigen::Quaterniond(to).normalized();
  const Eigen::AngleAxisd turn(last * first.conjugate());
  return turn.angle() * turn.axis();
}

Eigen::Vector3d shorterTurn(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to)
{
  if (from == to) return Eigen::Vector3d::Zero();
  return shorterTurnOfRotations(PolarDecomposition(from).rotation, PolarDecomposition(to).rotation);
}

bool isHalfTurn(const Eigen::Vector3d& shorter_turn)
{
  constexpr double kRounding = 0x1p-45; // of the angle between quaternions made of matrices
  return shorter_turn.norm() > std::numbers::pi - kRounding;
}

Eigen::Vector3d turnNearestTo(const Eigen::Vector3d& asked, const Eigen::Matrix3d& from, const Eigen::Matrix3d& to)
{
  const Eigen::Vector3d shorter = shorterTurn(from, to);
  const double length = asked.norm();
  if (length == 0.0) return shorter;
  // The motion's drift covers the rounding of long turns.
  constexpr double kSame = 1e-6;
  if (shorterTurn(rotationBy(asked) * from, to).norm() <= kSame) return asked;
  // The turn asked for does not lead to `to`. All turns that do differ by full turns about the axis of the shorter one.
  // Where the shorter turn is almost 0, its axis is noise.
  constexpr double full = 2.0 * std::numbers::pi, kNone = 1e-9;
  const double angle = shorter.norm();
  if (angle <= kNone) return full * std::round(length / full) * (asked / length);
  const Eigen::Vector3d axis = shorter / angle;
  return (angle + full * std::round((asked.dot(axis) - angle) / full)) * axis;
}

/// The point s is seen at U(t) = R'(t) (s - c(t)). R turns by a and c goes straight by d while t runs from 0 to 1, so
/// |U''| <= a^2 |s - c| + 2 a d. A curve strays from its chord by an eighth of its second derivative at most.
Bow bowSeenByBody(double angle, double way)
{
  return {angle * way / 4, angle * angle / 8};
}

} // namespace pcl_bsh
