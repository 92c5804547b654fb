// SPDX-License-Identifier: BSD-3-Clause
// The goal of a search for the closest pair, and when the search may end earlier.
#pragma once

#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/stop_rule.h>

#include <cmath>
#include <limits>
#include <optional>

namespace pcl_bsh {

struct ClosestGoal {
  explicit ClosestGoal(const Accuracy& accuracy, double up_to = std::numeric_limits<double>::infinity())
  : rule(accuracy),
    tolerance(accuracy.mode == Accuracy::Mode::tolerance ? accuracy.value : 0.0),
    max_distance(up_to)
  {
  }

  /// Pairs that are no nearer than this are passed over from the start.
  double most() const { return std::nextafter(max_distance, std::numeric_limits<double>::infinity()); }

  StopRule rule;
  double tolerance;    ///< the pair may be this much farther apart than the closest one
  double max_distance; ///< no pair that is farther apart is looked for; inclusive
  /// All that is asked is whether the distance exceeds this.
  double clearance = std::numeric_limits<double>::infinity();
};

/// The nearest pair found so far.
struct Nearest {
  std::optional<PointPair> pair;
  double low = std::numeric_limits<double>::infinity();     ///< at most the gap of the pair
  double high = std::numeric_limits<double>::infinity();    ///< at least the gap of the pair
  double to_beat = std::numeric_limits<double>::infinity(); ///< what is not nearer than this is passed over
};

/// Whether any pair is within the goal's clearance, as much about the distance as was learnt on the way, and the
/// nearest pair that was found. Best first: the interval narrows from both ends. @pre a rule that may stop
AnyResult searchWithin(const Placed& a, const Placed& b, const ClosestGoal& goal, const Watch& watch);

} // namespace pcl_bsh
