// SPDX-License-Identifier: BSD-3-Clause
// The smallest distance of two posed clouds, and the pair of points that realises it.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <limits>
#include <optional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Options of closestPair().
struct DistanceRequest : Effort {
  using Effort::Effort;
  /** Sets the effort alone. */ DistanceRequest(Effort effort) : Effort(std::move(effort)) {}
  DistanceRequest() = default;

  /// No pair that is farther apart is found: what is beyond costs as little as anyCollision(). >= 0, inclusive,
  /// infinity for no limit.
  double max_distance = std::numeric_limits<double>::infinity();
};

/// Result of closestPair().
struct DistanceResult {
  /// Smallest |T_a p - T_b q|, less the two points' radii where given (then negative = depth of overlap); rounded to
  /// the nearest double. Infinity when a cloud has no finite point, or no pair is within max_distance.
  double distance = std::numeric_limits<double>::infinity();
  std::optional<PointPair> pair; ///< the pair that realises it; of several, the smallest (a, b)
  /// Holds the smallest distance for certain. The neighbouring doubles of `distance` when the request's accuracy is
  /// exact; otherwise `distance` and `pair` are those of the nearest pair that was found, and the upper end. Without a
  /// pair it reaches from a lower bound, at most max_distance, to infinity.
  Interval interval;
  Work work;
};

/// The smallest distance and the pair that realises it. Several threads share a search that takes longer than about
/// 0.05 ms; its work then varies, for it depends on which of them finds a near pair when. Accuracies other
/// than exact take one thread.
/// @throws std::invalid_argument when max_distance, the accuracy or a pose is not what its declaration asks for.
///   Cancelled.
DistanceResult closestPair(const Placed& a, const Placed& b, const DistanceRequest& request = {});

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
