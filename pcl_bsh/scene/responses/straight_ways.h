// SPDX-License-Identifier: BSD-3-Clause
// The ways of an object's places, as straight as its motion has them.
#pragma once

#include <pcl_bsh/pairs/pairs_along.h>
#include <pcl_bsh/scene/state.h>
#include <pcl_bsh/scene/swept/object_motion.h>

namespace pcl_bsh {

/// The ways of one that stays as it is turned.
inline StraightWays shiftedBy(const Eigen::Vector3d& way, const Eigen::Isometry3d& from, double stray)
{
  return {from, Eigen::Matrix3d::Zero(), way, stray};
}

/// Ways stray by the bow of the turn.
inline StraightWays waysOn(const ObjectMotion& motion, double begin, double end)
{
  const Eigen::Isometry3d from = motion.at(begin), to = motion.at(end);
  return {from, to.linear() - from.linear(), to.translation() - from.translation(), motion.turningBow(end - begin)};
}

/// The ways of a part of what has these.
inline StraightWays waysOf(const StraightWays& object, const Eigen::Isometry3d& part)
{
  return {worldPoseOf(object.start, part), object.turn * part.linear(), object.way(part.translation()), object.stray};
}

} // namespace pcl_bsh
