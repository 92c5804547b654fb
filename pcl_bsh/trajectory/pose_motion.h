// SPDX-License-Identifier: BSD-3-Clause
// The motion from one pose to the next, as trajectory.h defines it.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <Eigen/Geometry>

namespace pcl_bsh {

/// What a pose's linear part is made of: R = rotation * stretch, the latter symmetric and within 1e-6 of the identity.
struct PoseParts {
  explicit PoseParts(const Eigen::Matrix3d& linear);

  Eigen::Matrix3d rotation; ///< the one nearest to R, to rounding
  Eigen::Matrix3d stretch;
};

/// At fraction f of the way the pivot is at (1 - f) T_from p + f T_to p; the rotation is spherically linear, the
/// stretch linear. So the motion begins and ends at the poses exactly as they were given, rigid or nearly so.
class PoseMotion {
public:
  /// @param pivot a point in the frame that the poses place
  PoseMotion(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, const Point3& pivot);

  /// Of the turn, in [0, pi]; 0 when both poses have the same linear part.
  double angle() const { return angle_; }

  /// Whether it is half a turn as far as double arithmetic can tell: either way round is as short.
  bool isAmbiguous() const;

  /// At a fraction in [0, 1].
  Eigen::Isometry3d at(double fraction) const;
  Eigen::Matrix3d rotationAt(double fraction) const;
  Eigen::Matrix3d stretchAt(double fraction) const;

private:
  Eigen::Isometry3d from_, to_;
  Eigen::Vector3d pivot_;
  PoseParts first_, last_;
  Eigen::Quaterniond first_rotation_, last_rotation_;
  double angle_ = 0.0;
};

} // namespace pcl_bsh
