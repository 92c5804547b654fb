// SPDX-License-Identifier: BSD-3-Clause
// Proves pairs of nodes beyond a reach, where thousands of pairs of triangles are hardly farther apart than the reach.
#pragma once

#include <pcl_bsh/traversal/planes_between.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace pcl_bsh {

/// Lays planes through the nearest places of a pair that is beyond the reach by some excess. Two other records are
/// beyond the reach, too, if the planes prove them no nearer than that pair, or nearer by less than the excess. Proves
/// nothing for clouds without triangles, for balls, and where pairs have reaches of their own.
class BeyondReach {
public:
  BeyondReach(const PointPairs& pairs, const SphereHierarchy::Storage& a, const SphereHierarchy::Storage& b)
  : pairs_(pairs),
    planes_(pairs.distance, a, b, kDecisionsBeforeAsked),
    may_know_(pairs.ofTriangles() && !pairs.mayOverlap() && pairs.ofPairs().isOne())
  {
  }

  /// Takes note of a pair that was decided to be beyond the reach. Compares one in 64 with the nearest of those
  /// compared before: the planes of a near pair are the least likely to cut a cloud.
  void found(PointPair beyond)
  {
    if (!may_know_) return;
    if (planes_.policy.decisionsInVain() % kDecisionsBetweenCompared == 0) {
      const RecordDistance::Enclosure gap = pairs_.distance.enclose(pairs_.posed(beyond));
      if (!nearest_ || gap.high < least_) {
        nearest_ = beyond, least_ = gap.low;
        is_laid_ = false;
        planes_.policy.wait(kDecisionsBeforeAsked);
      }
    }
    planes_.policy.decidedInVain();
  }

  /// Whether enough pairs were decided in vain to pay for asking about nodes.
  bool mayKnow() const { return planes_.policy.mayAsk(); }

  /// Whether all below two children is known to be beyond the reach.
  bool knows(const NodeChild& a, const NodeChild& b)
  {
    if (!is_laid_) lay();
    return planes_.policy.answered(planes_.touching(a, b).has_value());
  }

private:
  void lay()
  {
    is_laid_ = true;
    const double least = std::nextafter(pairs_.gap(*nearest_), 0.0);
    const double more = least - pairs_.ofPairs().around(*nearest_).second; // by which the pair exceeds the reach
    planes_.lay(*nearest_, std::max(more, 0.0) * (1.0 - kDoubleMargin));
  }

  static constexpr std::uint64_t kDecisionsBetweenCompared = 64;
  static constexpr std::uint64_t kDecisionsBeforeAsked = 1024; ///< they cost much more than planes

  const PointPairs& pairs_;
  PlanesBetween planes_;
  const bool may_know_;
  std::optional<PointPair> nearest_; ///< of those that were compared
  double least_ = 0.0;               ///< lower bound of its gap
  bool is_laid_ = false;             ///< whether the planes are those of `nearest_`
};

} // namespace pcl_bsh
