// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/stop_rule.h>

namespace pcl_bsh {

struct IntervalFinding {
  Interval interval;
  std::optional<PointPair> pair;        ///< realises a distance <= the upper end
  Verdict verdict = Verdict::undecided; ///< on the clearance asked about
  Work work;
};

/// Best first: the pair of spheres that may hold the smallest distance is opened next, so that the interval
/// narrows from both ends and may be had at any time (Klein, Zachmann: Point Cloud Collision Detection, 2004, order
/// their traversal so). More levels or more budget never widen it.
/// @param clearance the question is only whether the distance exceeds this; none: what it is
IntervalFinding searchInterval(const Placed& a, const Placed& b, const StopRule& rule, std::optional<double> clearance,
                               const Watch& watch);

} // namespace pcl_bsh
