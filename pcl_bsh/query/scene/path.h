// SPDX-License-Identifier: BSD-3-Clause
// The way of an object within a step.
#pragma once

#include <pcl_bsh/query/scene/bounds.h>

#include <Eigen/Geometry>

namespace pcl_bsh {

/// From pose to pose: the centre of the object's box on a straight line, the rotation at constant speed about one axis.
class Path {
public:
  Path(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, const Box3& box);

  /// @param s in [0, 1]; at(0) and at(1) are the very poses given
  Eigen::Isometry3d at(double s) const;

  const Eigen::Vector3d& shift() const { return shift_; } ///< of the centre
  bool turns() const { return angle_ != 0.0; }

  /// No point within `radius` of the centre travels farther per unit of s.
  double speed(double radius) const { return shift_.norm() + angle_ * radius; }

  /// Nor does this point, given in the object's frame.
  double speedOf(const Eigen::Vector3d& point) const
  {
    return turns() ? speed((point - center_).norm() * (1.0 + 0x1p-40)) : shift_.norm();
  }

  /// Nor does any point of the box.
  double speed() const { return speed(radius_); }

  /// Holds the object on all of its way.
  Box3 swept() const;

private:
  Eigen::Isometry3d from_, to_;
  Box3 box_;
  Eigen::Vector3d center_;       // in the object's frame
  Eigen::Vector3d world_center_; // at s = 0
  Eigen::Vector3d shift_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();
  double angle_ = 0.0;
  double radius_ = 0.0; // of the box around its centre
};

} // namespace pcl_bsh
