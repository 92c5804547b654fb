// SPDX-License-Identifier: BSD-3-Clause
// Summaries of a pose that were made of parts of a scan.
#pragma once

#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>

namespace pcl_bsh {

/// Makes a summary that of its points and of `more`'s, which are others. @pre both are of one pose
inline void addSummary(PoseSummary& pose, const PoseSummary& more)
{
  pose.colliding = pose.colliding || more.colliding;
  pose.colliding_points += more.colliding_points;
  pose.undecided_points += more.undecided_points;
  pose.distance = std::min(pose.distance, more.distance);
}

} // namespace pcl_bsh
