// SPDX-License-Identifier: BSD-3-Clause
// The straight ways that an object's places take, nearly, during its motion.
#pragma once

#include <pcl_bsh/pairs/pairs_along.h>
#include <pcl_bsh/scene/state.h>
#include <pcl_bsh/scene/swept/object_motion.h>

namespace pcl_bsh {

/// Returns the ways of an object that does not turn.
inline StraightWays shiftedBy(const Eigen::Vector3d& way, const Eigen::Isometry3d& from, double stray)
{
  return {from, Eigen::Matrix3d::Zero(), way, stray};
}

/// Returns the ways of an object from s = begin to end of a motion. They stray by the bow of the turn.
inline StraightWays waysOn(const ObjectMotion& motion, double begin, double end)
{
  const Eigen::Isometry3d from = motion.at(begin), to = motion.at(end);
  return {from, to.linear() - from.linear(), to.translation() - from.translation(), motion.turningBow(end - begin)};
}

/// Returns the ways of a part of an object. @param object its ways @param part T_object_cloud
inline StraightWays waysOf(const StraightWays& object, const Eigen::Isometry3d& part)
{
  return {worldPoseOf(object.start, part), object.turn * part.linear(), object.way(part.translation()), object.stray};
}

} // namespace pcl_bsh
