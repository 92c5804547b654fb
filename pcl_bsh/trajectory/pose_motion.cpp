// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/pose_motion.h>

#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cmath>

namespace pcl_bsh {

/// Newton's iteration for the orthogonal factor squares what is missing to it: from 1e-6 to rounding in two steps.
PoseParts::PoseParts(const Eigen::Matrix3d& linear) : rotation(linear)
{
  for (int i = 0; i < 2; ++i) rotation = (0.5 * (rotation + rotation.inverse().transpose())).eval();
  const Eigen::Matrix3d product = rotation.transpose() * linear;
  stretch = 0.5 * (product + product.transpose());
}

PoseMotion::PoseMotion(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, const Point3& pivot)
: from_(from),
  to_(to),
  pivot_(pivot[0], pivot[1], pivot[2]),
  first_(from.linear()),
  last_(to.linear()),
  first_rotation_(Eigen::Quaterniond(first_.rotation).normalized()),
  last_rotation_(Eigen::Quaterniond(last_.rotation).normalized())
{
  if (from.linear() != to.linear()) angle_ = first_rotation_.angularDistance(last_rotation_);
}

bool PoseMotion::isAmbiguous() const
{
  constexpr double kRounding = 0x1p-46; // of quaternions made of matrices
  return std::abs(first_rotation_.dot(last_rotation_)) < kRounding;
}

Eigen::Matrix3d PoseMotion::rotationAt(double fraction) const
{
  if (fraction <= 0.0 || from_.linear() == to_.linear()) return first_.rotation;
  if (fraction >= 1.0) return last_.rotation;
  return first_rotation_.slerp(fraction, last_rotation_).normalized().toRotationMatrix();
}

Eigen::Matrix3d PoseMotion::stretchAt(double fraction) const
{
  return (1.0 - fraction) * first_.stretch + fraction * last_.stretch;
}

Eigen::Isometry3d PoseMotion::at(double fraction) const
{
  if (fraction <= 0.0) return from_;
  if (fraction >= 1.0) return to_;
  Eigen::Isometry3d pose = from_;
  if (from_.linear() == to_.linear()) {
    pose.translation() = (1.0 - fraction) * from_.translation() + fraction * to_.translation();
    return pose;
  }
  pose.linear() = rotationAt(fraction) * stretchAt(fraction);
  pose.translation() = (1.0 - fraction) * (from_ * pivot_) + fraction * (to_ * pivot_) - pose.linear() * pivot_;
  return pose;
}

Eigen::Isometry3d poseBetween(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double fraction,
                              const Point3& pivot)
{
  const PoseMotion motion(from, to, pivot);
  if (fraction > 0.0 && fraction < 1.0 && motion.isAmbiguous())
    throw InvalidInput(Input::pose, "motion between two poses", "half a turn, and either way round is as short",
                       "give a pose between them");
  return motion.at(fraction);
}

} // namespace pcl_bsh
