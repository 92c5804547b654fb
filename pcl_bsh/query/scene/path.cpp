// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/scene/path.h>

namespace pcl_bsh {

Path::Path(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, const Box3& box)
: from_(from),
  to_(to),
  box_(box),
  center_(box.empty() ? Eigen::Vector3d::Zero() : box.center()),
  world_center_(from * center_),
  shift_(to.translation() - from.translation()),
  radius_(box.empty() ? 0.0 : box.half().norm() * (1.0 + 0x1p-40))
{
  if (from.linear() == to.linear()) return;
  shift_ = to * center_ - world_center_;
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  axis_ = turn.axis();
  angle_ = turn.angle();
}

Eigen::Isometry3d Path::at(double s) const
{
  if (s <= 0.0) return from_;
  if (s >= 1.0) return to_;
  Eigen::Isometry3d pose = from_;
  if (!turns()) {
    pose.translation() += s * shift_;
    return pose;
  }
  pose.linear() = Eigen::Quaterniond(Eigen::AngleAxisd(s * angle_, axis_) * Eigen::Quaterniond(from_.linear()))
                      .normalized()
                      .matrix();
  pose.translation() = world_center_ + s * shift_ - pose.linear() * center_;
  return pose;
}

Box3 Path::swept() const
{
  Box3 box = moved(box_, from_);
  box.merge(moved(box_, to_));
  if (turns() && !box_.empty()) {
    Box3 ball{world_center_, world_center_};
    ball.merge({world_center_ + shift_, world_center_ + shift_});
    ball.grow(radius_ * (1.0 + 0x1p-30));
    box.merge(ball);
  }
  return box;
}

} // namespace pcl_bsh
