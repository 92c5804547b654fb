// SPDX-License-Identifier: BSD-3-Clause
// A ball as a scanner sees it, and whether a beam leaves it open that something is in it.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

/// A direction lies between beams that are at most this many angles from it. It is the sum of the angle, from the
/// middle of a cell of directions (direction_cells.h), and half the diagonal of a cell, less than 0.18 of the angle.
inline constexpr double kBetweenOfAngle = 1.2;

/// All directions up to this many angles from a seen one lie between beams. It is half a step of an even grid: a corner
/// of a right angle that reaches farther over the last row of beams, or into a hole, meets a beam.
inline constexpr double kMarginOfAngle = 0.334;

/// A beam counts for directions up to this many angles from its own. A right angle, at any place of an even grid that
/// lost a single beam, holds a beam nearer than sqrt(5) steps; the angle is 1.5 steps.
inline constexpr double kReachOfAngle = 1.5;

/// The directions that a beam counts for, and the share of its range that it is sure of.
struct BeamAngle {
  explicit BeamAngle(double radians, double reach_of_angle = kReachOfAngle)
  : reach(reach_of_angle * radians),
    sine(std::sin(reach)),
    cosine(std::cos(reach)),
    sure(1.0 - radians)
  {
  }
  double reach, sine, cosine, sure;
};

/// Lengths are enlarged by this share of all coordinates that they were computed of: more than the some thirty
/// roundings of a pose, of BallView and of leavesOpen() err by together.
inline constexpr double kBallViewSlack = 0x1p-46;

/// A ball, seen from the origin of a scan. Where a length is rounded, the ball grows.
struct BallView {
  /// @param center rounded from terms of at most `magnitude`. @param guard slacks on top of the radius: with 8, a beam
  ///   that leaves nothing of this ball open leaves nothing open of any ball in it
  BallView(const Point3& origin, const Eigen::Vector3d& center, double magnitude, double ball, double guard = 0.0)
  : way(center - Eigen::Vector3d(origin.data())),
    distance(way.norm()),
    slack(kBallViewSlack * (magnitude + Eigen::Vector3d(origin.data()).lpNorm<1>() + distance + ball)),
    radius(ball + (1.0 + guard) * slack),
    is_around(distance <= radius),
    direction(is_around ? Eigen::Vector3d::UnitX() : Eigen::Vector3d(way / distance)),
    farthest(distance + radius + 4.0 * slack)
  {
  }

  Eigen::Vector3d way; ///< from the origin to the centre
  double distance, slack, radius;
  bool is_around; ///< the origin is in the ball
  Eigen::Vector3d direction;
  double farthest; ///< a beam that is empty up to here leaves nothing open

  /// Whether no square overflows; a ball with one that does is not seen.
  bool isMeasured() const { return std::isfinite(farthest * farthest); }

  /// Half the angle of its cone, at least. @pre not around
  double coneAngle() const { return std::asin(std::min(1.0, (radius + 4.0 * slack) / distance)); }
};

/// How far apart unit vectors are whose angle is this, at least.
inline double chordOf(double angle)
{
  return 2.0 * std::sin(0.5 * angle) * (1.0 + 0x1p-40);
}

/// Whether a beam leaves it open that something is in the ball: it counts for a direction that leaves the ball where
/// the beam is not surely empty. It suffices to test the direction nearest to the ball's centre, which leaves the ball
/// last. This is the beam's own, turned towards the centre by at most the reach.
/// @param beam not 0; its length does not matter. @param empty how far it went, of which `speaks.sure` counts
inline bool leavesOpen(const BallView& ball, const Eigen::Vector3d& beam, double empty, const BeamAngle& speaks)
{
  const Eigen::Vector3d unit = beam / beam.norm(); // products of both lengths would overflow
  double along = ball.distance, off = 0.0;         // of the centre, seen in that direction
  if (ball.distance > 0.0) {
    const double cosine = ball.way.dot(unit) / ball.distance;
    const double sine = ball.way.cross(unit).norm() / ball.distance;
    const double sine_left = sine * speaks.cosine - cosine * speaks.sine;
    if (sine_left > 0.0) {
      along = ball.distance * (cosine * speaks.cosine + sine * speaks.sine);
      off = std::max(0.0, ball.distance * sine_left - ball.slack);
    }
  }
  if (off > ball.radius || (along < -ball.slack && !ball.is_around)) return false;
  return along + ball.slack + std::sqrt(ball.radius * ball.radius - off * off) >=
         empty * speaks.sure * (1.0 - kBallViewSlack);
}

/// Whether a beam counts for the direction of a place and went beyond it. The place is a ball of radius 0, and not
/// around the origin. The beam is not 0, and its length does not matter. It is empty for the length `empty`.
inline bool passes(const BallView& place, const Eigen::Vector3d& beam, double empty, const BeamAngle& speaks)
{
  if (!(empty > place.distance + place.slack)) return false;
  const Eigen::Vector3d unit = beam / beam.norm();
  const double cosine = place.way.dot(unit) / place.distance, sine = place.way.cross(unit).norm() / place.distance;
  return cosine > 0.0 && sine * speaks.cosine <= cosine * speaks.sine;
}

} // namespace pcl_bsh
