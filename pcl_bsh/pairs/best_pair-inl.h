// SPDX-License-Identifier: BSD-3-Clause
// The best pair that a search for the closest one has found, and what follows from it for the pairs that are left.

#if defined(PCL_BSH_PAIRS_BEST_PAIR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_PAIRS_BEST_PAIR_INL_H_
#undef PCL_BSH_PAIRS_BEST_PAIR_INL_H_
#else
#define PCL_BSH_PAIRS_BEST_PAIR_INL_H_
#endif

#include <pcl_bsh/pairs/closest_goal.h>
#include <pcl_bsh/traversal/pair_walk-inl.h>
#include <pcl_bsh/traversal/planes_between.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class BestPair {
public:
  /// Whether the distance exceeds the goal's clearance, as run() has found; with the nearest pair.
  AnyResult verdict(const DistanceResult& found) const
  {
    const bool is_free = static_cast<double>(left_over_) > goal_.clearance;
    const Verdict verdict = settled_ ? Verdict::colliding : is_free ? Verdict::free : Verdict::undecided;
    return {verdict, found.pair, found.interval, found.work};
  }

protected:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  BestPair(const Placed& a, const Placed& b, const ClosestGoal& goal) : goal_(goal), walk_(a, b), pairs_(a, b, 0.0)
  {
    walk_.makeWholes();
    best_.to_beat = goal_.most();
    sharp_ = 0x1p-36 * smallerRadius();
  }

  /// No pair is nearer than this, where none was found.
  double leastBeyond() const
  {
    const bool is_empty = walk_.a.storage.size == 0 || walk_.b.storage.size == 0;
    return is_empty ? kInfinity : std::min(static_cast<double>(left_over_), goal_.max_distance);
  }

  /// Holds the smallest distance: all pairs that were passed over are no nearer than the best less the tolerance.
  Interval intervalOf(double gap) const
  {
    const double lower = std::nextafter(gap, -kInfinity) - goal_.tolerance;
    const double known =
        goal_.tolerance > 0.0 ? std::nextafter(lower, -kInfinity)
        : goal_.rule.mayStop()
            ? std::min({std::max(lower, best_lower_), static_cast<double>(left_over_), goal_.clearance})
            : lower;
    return {std::max(known, static_cast<double>(lowest_key_)), std::min(best_.high, std::nextafter(gap, kInfinity))};
  }

  /// A pair is worth a visit if it may be nearer, or as near with smaller record numbers.
  bool canImprove(const LanePair& pair) const
  {
    const double bound = std::max(pair.key, lowest_key_);
    if (bound < best_.to_beat) return true;
    if (bound > best_.to_beat || goal_.tolerance > 0.0 || !best_.pair) return false;
    return walk_.lowest(pair) < *best_.pair;
  }

  /// Returns a key for a child that may be at a distance of 0: below 0, and the smaller, the more the spheres overlap
  /// for their size.
  static float overlapOf(const PairWalk::Step& step, std::uint32_t lane)
  {
    const float radius = step.children.r[lane] * step.children.stretch;
    const float overlap = (step.gap[lane] + radius) / (radius + step.radius); // 0: one centre, 1: they touch
    return overlap < 2.0f ? overlap - 2.0f : 0.0f;
  }

  /// Returns two record numbers. Among records that touch the planes, no pair with smaller numbers is as near as the
  /// best. A record of b that touches only where `looked_round_` does is no nearer than `looked_round_`, which was
  /// compared with all of a. So it makes no better pair with a record of a below the best pair's.
  PointPair firstAmong(const PlanesBetween::Touching& touching) const
  {
    const auto& [of_a, of_b] = touching;
    if (of_a.lowest >= best_.pair->a) return {of_a.lowest, of_b.lowest};
    if (of_b.elsewhere != BehindPlane::kNoRecord) return {of_a.lowest, of_b.elsewhere};
    return {best_.pair->a, of_b.lowest};
  }

  /// Takes the candidate for the best pair where it is nearer, or as near with smaller record numbers. Returns whether
  /// it did.
  bool take(PointPair candidate)
  {
    const bool none_nearer = none_nearer_ || (best_.high == 0.0 && !pairs_.mayOverlap()); // nothing is nearer than 0
    if (none_nearer && *best_.pair < candidate) return false;
    const RecordDistance::Pair posed = pairs_.posed(candidate);
    ++walk_.work.exact_decisions;
    ++steps_in_vain_;
    planes_.policy.decidedInVain();
    const double most = best_.pair ? best_.high : goal_.max_distance;
    if (pairs_.ofTriangles() && pairs_.distance.isSurelyBeyond(posed, most)) return false;
    if (planes_.areBeyond(candidate)) return false;
    if (best_.pair) {
      if (!(best_posed_.records == *best_.pair)) best_posed_ = pairs_.posed(*best_.pair);
      const int sign = pairs_.distance.compareGaps(posed, best_posed_);
      if (sign > 0 || (sign == 0 && *best_.pair < candidate)) return false;
      if (sign == 0) {
        best_lower_ = std::max(best_lower_, static_cast<double>(at_least_));
        best_.pair = candidate;
        return true;
      }
    }
    else if (goal_.max_distance < kInfinity && pairs_.distance.compare(posed, goal_.max_distance) > 0) {
      return false;
    }
    best_.pair = candidate;
    best_posed_ = posed;
    steps_in_vain_ = 0, has_looked_round_ = false;
    planes_.clear(), planes_of_ = kInfinity;
    best_lower_ = static_cast<double>(at_least_);
    const auto [low, high] = boundGap(posed);
    best_.low = low;
    best_.high = low <= 0.0 && pairs_.distance.compare(posed, 0.0) == 0 ? 0.0 : high;
    if (low <= goal_.clearance && goal_.clearance < kInfinity && pairs_.distance.compare(posed, goal_.clearance) <= 0) {
      settled_ = true;
      best_.high = std::min(best_.high, goal_.clearance);
    }
    best_.to_beat = goal_.tolerance > 0.0 ? std::nextafter(best_.high - goal_.tolerance, -kInfinity)
                                          : std::min(best_.high, std::nextafter(goal_.clearance, kInfinity));
    return true;
  }

  const ClosestGoal goal_;
  PairWalk walk_;
  PointPairs pairs_;
  /// Without radii no distance is below 0, so that pairs at 0 are settled by their record numbers.
  const float lowest_key_ = pairs_.mayOverlap() ? -std::numeric_limits<float>::infinity() : 0.0f;
  float left_over_ = std::numeric_limits<float>::infinity(); ///< no pair that was left is nearer
  float at_least_ = -std::numeric_limits<float>::infinity(); ///< lower bound of the gaps that are considered
  double best_lower_ = -kInfinity;                           ///< lower bound of the best pair's gap
  bool settled_ = false;                                     ///< a pair is within the goal's clearance
  Nearest best_;
  RecordDistance::Pair best_posed_; ///< of the best pair, or of one before it

  static constexpr std::uint64_t kDecisionsBeforePlanes = 256;
  PlanesBetween planes_{pairs_.distance, walk_.a.storage, walk_.b.storage,
                        kDecisionsBeforePlanes}; ///< of the best pair
  double planes_of_ = kInfinity;                 ///< Nearest::high of the pair that they were laid for
  std::uint64_t steps_in_vain_ = 0;              ///< since a nearer pair was found: decisions and pairs of leaves
  const std::uint64_t steps_to_look_round_ = 2 * (std::uint64_t{walk_.a.storage.size} + walk_.b.storage.size);
  bool has_looked_round_ = false;
  std::uint32_t looked_round_ = BehindPlane::kNoRecord; ///< record of b that lookRound() compared with all of a
  bool none_nearer_ = false;                            ///< nothing below the visited pair is nearer than the best

private:
  /// Bounds of a pair's gap: those of double arithmetic, if they are so narrow beside the clouds' size that the search
  /// looks at no more pairs for them. Rounding the gap takes ten times as long.
  RecordDistance::Enclosure boundGap(const RecordDistance::Pair& posed) const
  {
    if (!pairs_.ofTriangles()) {
      const auto [low, high] = pairs_.distance.enclose(posed);
      const double radii = posed.radius_p + posed.radius_q, rounding = kFewDoubleRoundings * (high + radii);
      if (high - low + rounding < sharp_) return {low - radii - rounding, high - radii + rounding};
    }
    const double gap = pairs_.distance.gap(posed);
    return {std::nextafter(gap, -kInfinity), std::nextafter(gap, kInfinity)};
  }

  /// The radius of the smaller one of both clouds as wholes. @pre makeWholes()
  double smallerRadius() const
  {
    const auto radiusOf = [](const Spaces& side) {
      return side.storage.size == 0 ? 0.0 : side.node(kAboveVoxels, side.whole()).r[0] * side.storage.frame.unit;
    };
    return std::min(radiusOf(walk_.a), radiusOf(walk_.b));
  }

  double sharp_ = 0.0; ///< intervals of gaps that are narrower are taken for the gap
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
