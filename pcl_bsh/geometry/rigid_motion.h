// SPDX-License-Identifier: BSD-3-Clause
// The motion from one pose to another: one model for trajectories, scenes and waypoints.
#pragma once

#include <Eigen/Geometry>

#include <cmath>

namespace pcl_bsh {

/// A point of a moving body: at center + s shift + R(s) (spoke + s drift), where R turns by s angle about the axis.
struct PointMotion {
  Eigen::Vector3d center, shift, axis, spoke, drift;
  double angle;

  /// From the centre to the point.
  Eigen::Vector3d spokeAt(double s) const
  {
    const Eigen::Vector3d x = spoke + s * drift;
    if (angle == 0.0) return x;
    const Eigen::Vector3d along = axis.dot(x) * axis;
    return along + std::cos(s * angle) * (x - along) + std::sin(s * angle) * axis.cross(x);
  }
};

/// While s goes from 0 to 1, one point of the body, the pivot, moves straight at constant speed. The body turns at
/// constant speed about an axis of fixed direction, by an angle of any size:
///
///   pose(s) p = (1 - s) from pivot + s to pivot + R(s) (p - pivot),   R(s) = exp(s turn) (R_from + s drift),
///
/// where drift = exp(-turn) R_to - R_from is the part of the last pose's linear part that the turn does not reach:
/// rounding, and the deviation of poses from rigid ones (1e-6 at most). So the motion begins and ends at the very poses
/// given and has no jump. Lengths are in the poses' unit, angles in radians.
class RigidMotion {
public:
  /// @param pivot in the frame that the poses place
  /// @param turn from the first pose to the last, seen by the world: axis times angle
  RigidMotion(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, const Eigen::Vector3d& pivot,
              const Eigen::Vector3d& turn);

  /// @param s in [0, 1], clamped; at(0) and at(1) are the poses given, bit for bit
  Eigen::Isometry3d at(double s) const;

  const Eigen::Isometry3d& from() const { return from_; }
  const Eigen::Isometry3d& to() const { return to_; }
  const Eigen::Vector3d& pivot() const { return pivot_; }
  const Eigen::Vector3d& worldPivot() const { return world_pivot_; } ///< at s = 0
  const Eigen::Vector3d& shift() const { return shift_; }            ///< of the pivot
  double angle() const { return angle_; }                            ///< >= 0
  bool turns() const { return turns_; }                              ///< false: a translation

  /// @param point in the frame that the poses place
  PointMotion motionOf(const Eigen::Vector3d& point) const;

  /// A point no farther than `radius` from the pivot goes by at most shift().norm() + turningSpeed(radius) per unit of
  /// s.
  double turningSpeed(double radius) const;

  /// Within any interval of s of length `length`, a point no farther than `radius` from the pivot moves at most this
  /// much farther than the pivot. This holds however often the body turns.
  double turningReach(double radius, double length) const;

  /// No pose of the motion lengthens the distance of two points of the body by a larger factor.
  double stretch() const { return stretch_; }

private:
  Eigen::Isometry3d from_, to_;
  Eigen::Vector3d pivot_, world_pivot_, shift_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();
  double angle_ = 0.0;
  bool turns_ = false;
  Eigen::Matrix3d drift_ = Eigen::Matrix3d::Zero();
  double drift_size_ = 0.0; // Frobenius norm
  double stretch_ = 1.0;
};

/// axis times angle as a matrix.
Eigen::Matrix3d rotationBy(const Eigen::Vector3d& turn);

/// The shorter turn from one linear part of a pose to another, at most half a turn: axis times angle, of the rotations
/// nearest to them; exactly 0 between equal ones.
Eigen::Vector3d shorterTurn(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to);

/// shorterTurn() for matrices that are rotations to rounding.
Eigen::Vector3d shorterTurnOfRotations(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to);

/// Whether a shorter turn is half a turn as far as double arithmetic can tell, so that the other way is as short.
bool isHalfTurn(const Eigen::Vector3d& shorter_turn);

/// The turn from one linear part to the other, with more or fewer full turns, that is nearest to the one asked for; the
/// shorter one when nothing is asked for.
Eigen::Vector3d turnNearestTo(const Eigen::Vector3d& asked, const Eigen::Matrix3d& from, const Eigen::Matrix3d& to);

/// A body turns by `angle` while its pivot goes straight by `way`, and sees a point at rest. Seen by the body, the
/// point strays from the straight line between its first and last place. At each instant it does so by at most drift +
/// turn * (its distance from the pivot's way).
struct Bow {
  double drift, turn;
};
Bow bowSeenByBody(double angle, double way);

} // namespace pcl_bsh
