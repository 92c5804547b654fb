// SPDX-License-Identifier: BSD-3-Clause
// How far a pose may truly be from what it was estimated to be: a length, and an angle about a place.
//
//   question.pose_uncertainty = {0.01, 0.002, {0, 0, 1.5}};                      // numbers
//   question.pose_uncertainty = PoseUncertainty::of(covariance, 3.0, {0, 0, 1}); // three sigmas of a registration's
//
// Points of the body move together, by at most length + 2 sin(angle / 2) times their distance from the place.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/point3.h>

#include <Eigen/Core>

#include <string>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The true pose turns the body, as placed, by at most the angle about any axis through the place, and shifts it by at
/// most the length.
struct PoseUncertainty {
  double length = 0.0;      ///< in the clouds' unit; finite and >= 0
  double angle = 0.0;       ///< in radians; finite and >= 0
  Point3 about = {0, 0, 0}; ///< in the frame of the body that is placed

  bool isZero() const noexcept { return length == 0.0 && angle == 0.0; } ///< the pose is exact
  /// Whether both say the same.
  bool operator==(const PoseUncertainty& other) const
  {
    return length == other.length && angle == other.angle && about == other.about;
  }

  /// Returns how far a place in the ball about a point moves at most when the body turns by the angle; rounded upward.
  double turned(const Point3& point, double radius) const;

  /// Returns the uncertainty of normal errors.
  /// @param covariance of x y z and of a rotation vector about them, in that order, the rotation in radians: symmetric,
  ///   positive semidefinite. @param sigmas how many standard deviations the pose is off at most. Length and angle are
  ///   each so many times the greatest deviation in any direction. @param about the place that the covariance is about
  /// @throws InvalidInput naming the value
  static PoseUncertainty of(const Eigen::Matrix<double, 6, 6>& covariance, double sigmas,
                            const Point3& about = {0, 0, 0});

  /// `T`, `T,W` or `T,W,X,Y,Z`: length, angle and place; or `covariance=K:` and its 36 numbers with commas between,
  /// about the origin. Empty: exact. @throws InvalidInput quoting the text
  static PoseUncertainty parse(const std::string& text);
  std::string text() const; ///< what parse() reads, as numbers
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
