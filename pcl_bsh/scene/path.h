// SPDX-License-Identifier: BSD-3-Clause
// The way of an object within a step.
#pragma once

#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/scene/bounds.h>
#include <pcl_bsh/scene/motion.h>

#include <Eigen/Geometry>

namespace pcl_bsh {

/// The turn that takes one rotation to another (within rounding) and is nearest to the one asked for, full turns
/// included; nothing asked for: the shorter one.
Eigen::Vector3d turnBetween(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to, const Eigen::Vector3d& asked);

/// A point on a path. It is at center + s shift + R(s) (spoke + s drift), where R turns about the axis by s angle.
struct PointCourse {
  Eigen::Vector3d center, shift, axis, spoke, drift;
  double angle;

  Eigen::Vector3d spokeAt(double s) const
  {
    const Eigen::Vector3d x = spoke + s * drift;
    if (angle == 0.0) return x;
    const Eigen::Vector3d along = axis.dot(x) * axis;
    return along + std::cos(s * angle) * (x - along) + std::sin(s * angle) * axis.cross(x);
  }
};

/// A leg and the box of what goes along it. R(s) = exp(s turn) (R_from + s drift): the drift is what the turn misses of
/// the last rotation, by rounding or because the poses given are not quite rigid. So the way has no jump anywhere.
class Path {
public:
  Path(const Leg& leg, const Box3& box);

  /// @param s in [0, 1]; at(0) and at(1) are the very poses given
  Eigen::Isometry3d at(double s) const;

  const Eigen::Vector3d& shift() const { return shift_; } ///< of the centre
  bool turns() const { return turns_; }
  double angle() const { return angle_; } ///< radians, >= 0, of any size

  /// No point of the box travels farther than this per unit of s, besides its centre's shift.
  double turningSpeed() const { return turns_ ? (angle_ * stretch_ + drift_size_) * radius_ : 0.0; }

  /// Nor is it farther than this from where it was `length` of s before, besides the shift, however often it turns.
  double turningReach(double length) const;

  /// No point of the box travels farther per unit of s.
  double speed() const { return shift_.norm() + turningSpeed(); }

  /// No point of the box gets farther than this from where it is at s = 0.
  double reach() const { return (shift_.norm() + turningReach(1.0)) * (1.0 + kDoubleMargin); }

  /// @param point in the object's frame
  PointCourse courseOf(const Eigen::Vector3d& point) const;

  /// Holds the object on all of its way.
  Box3 swept() const;

  /// Positions on the path that are computed in double err by less: some forty roundings of the largest coordinate that
  /// goes into them, and of the whole way, since s is rounded, too.
  double rounding() const;

private:
  Eigen::Isometry3d from_, to_;
  Box3 box_;
  Eigen::Vector3d center_;       // in the object's frame
  Eigen::Vector3d world_center_; // at s = 0
  Eigen::Vector3d shift_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();
  double angle_ = 0.0;
  bool turns_ = false;
  Eigen::Matrix3d drift_ = Eigen::Matrix3d::Zero();
  double drift_size_ = 0.0; // Frobenius norm
  double stretch_ = 1.0;    // of lengths, by rotations that are not quite rigid
  double radius_ = 0.0;     // of the box around its centre
};

} // namespace pcl_bsh
