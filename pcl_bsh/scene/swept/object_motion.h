// SPDX-License-Identifier: BSD-3-Clause
// The motion of an object within a step, with bounds for all of its points.
#pragma once

#include <pcl_bsh/geometry/rigid_motion.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/scene/motion.h>
#include <pcl_bsh/scene/pairs/object_boxes.h>

#include <algorithm>

namespace pcl_bsh {

/// A RigidMotion and the box of what it moves, in the frame that the poses place.
class ObjectMotion : public RigidMotion {
public:
  ObjectMotion(const Leg& leg, const Box3& box);

  /// As in RigidMotion, for all points of the box.
  double turningSpeed() const { return RigidMotion::turningSpeed(radius_); }
  double turningReach(double length) const { return RigidMotion::turningReach(radius_, length); }
  /// Within an interval of this length no point of the box strays farther from where it would be if it went straight,
  /// at constant speed, from its first to its last place there. Two places about the pivot are no farther apart than
  /// twice the radius.
  double turningBow(double length) const
  {
    const double turn = angle() * length, drift = 2.0 * (stretch() - 1.0) * length;
    return std::min(turn * (turn * stretch() + drift) / 8.0, 2.0 * stretch()) * radius_;
  }

  /// No point of the box travels farther per unit of s.
  double speed() const { return shift().norm() + turningSpeed(); }

  /// Holds the object at every instant.
  Box3 swept() const;

  /// Positions that are computed in double err by less: some forty roundings of the largest coordinate that goes into
  /// them, and of the whole length, since s is rounded, too.
  double rounding() const;

private:
  Box3 box_;
  double radius_; // of the box around the pivot
};

} // namespace pcl_bsh
