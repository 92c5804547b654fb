// SPDX-License-Identifier: BSD-3-Clause
// The closest pair: depth first, nearest children first, until nothing left can be nearer. (A heap of pairs, best
// first, visits as many nodes and spends more than half of the time on itself.)
#include <pcl_bsh/collision/check_request.h>
#include <pcl_bsh/collision/collide.h>
#include <pcl_bsh/collision/interval_search.h>

#include <algorithm>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/collision/closest_pair.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/traversal/pair_walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class ClosestSearch {
public:
  ClosestSearch(const Placed& a, const Placed& b, const Accuracy& accuracy)
  : walk_(a, b),
    pairs_(a, b, 0.0),
    tolerance_(accuracy.mode == Accuracy::Mode::tolerance ? accuracy.value : 0.0),
    proven_(accuracy.isProven())
  {
  }

  DistanceResult run()
  {
    stack_.clear();
    walk_.seed(kInfinity, [this](const LanePair& pair, const PairWalk::Step& step, std::uint32_t lane) {
      push(pair, step, lane);
    });
    nearestLast(stack_, 0);
    while (!stack_.empty()) {
      const LanePair pair = stack_.back();
      stack_.pop_back();
      if (canImprove(pair)) visit(pair);
    }
    return {best_gap_, best_, proven_ ? interval() : Interval{}, walk_.work};
  }

private:
  void visit(const LanePair& pair)
  {
    const Opened opened = walk_.choose(pair);
    if (opened == Opened::neither) return compareLeaves(pair);
    PairWalk::Step step;
    walk_.step(pair, opened, clearanceToBeat(), step);
    const std::size_t from = stack_.size();
    for (std::uint32_t near = step.near; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      push(PairWalk::childOf(pair, opened, step, lane), step, lane);
    }
    nearestLast(stack_, from);
  }

  void push(LanePair pair, const PairWalk::Step& step, std::uint32_t lane)
  {
    pair.key = keyOf(walk_.lowerBound(pair, step, lane));
    if (canImprove(pair)) stack_.push_back(pair);
  }

  /// Nothing was passed over but what is no nearer than the best less the tolerance.
  Interval interval() const
  {
    if (!best_) return {kInfinity, kInfinity};
    const double lower = std::nextafter(best_gap_, -kInfinity) - tolerance_;
    return {std::max(tolerance_ > 0.0 ? std::nextafter(lower, -kInfinity) : lower, static_cast<double>(lowestKey())),
            best_high_};
  }

  /// Distances above this are of no interest.
  double clearanceToBeat() const { return std::max(to_beat_, 0.0); }

  /// A pair is worth a visit if it may be nearer, or as near with smaller record numbers.
  bool canImprove(const LanePair& pair) const
  {
    const double bound = std::max(pair.key, lowestKey());
    if (bound < to_beat_) return true;
    if (bound > to_beat_ || tolerance_ > 0.0) return false;
    return PointPair{lowest(walk_.a, pair.a), lowest(walk_.b, pair.b)} < *best_;
  }

  std::uint32_t lowest(const Spaces& side, const Lane& lane) const
  {
    return walk_.nodeOf(side, lane).lowest[lane.lane];
  }

  /// A lower bound as a key. NaN is no bound at all.
  static float keyOf(double bound)
  {
    return std::isnan(bound) ? -std::numeric_limits<float>::infinity() : roundDownToFloat(bound);
  }

  static float roundDownToFloat(double value)
  {
    const auto rounded = static_cast<float>(value);
    return static_cast<double>(rounded) > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity())
                                                : rounded;
  }

  /// Without radii no distance is below 0, so that pairs at 0 are settled by their record numbers.
  float lowestKey() const { return pairs_.haveRadii() ? -std::numeric_limits<float>::infinity() : 0.0f; }

  void compareLeaves(const LanePair& pair)
  {
    ++walk_.work.leaf_pairs;
    const LeafRange a = walk_.leaf(walk_.a, pair.a), b = walk_.leaf(walk_.b, pair.b);
    const RelativeFrame& frame = walk_.frames.find(pair.a.space, pair.b.space);
    LeafPoints points;
    carryLeaf(frame, a, points);
    const double unit = walk_.b.frame(pair.b.space).unit;
    const auto found = [&](std::uint32_t i, std::uint32_t j, float squared) {
      const PointPair candidate{a.record(i), b.record(j)};
      if (proven_)
        consider(candidate);
      else
        believe(candidate, std::sqrt(static_cast<double>(squared)) * unit - a.radius(i) - b.radius(j));
      return false;
    };
    if (pairs_.haveRadii()) {
      eachBallPairNear(frame, points, firstBits(a.count), a, b, to_beat_, found);
      return;
    }
    eachPairMaybeNearest(frame, points, a, b, unit, clearanceToBeat(), found);
  }

  void consider(PointPair candidate)
  {
    const ExactDistance::Pair posed = pairs_.posed(candidate);
    ++walk_.work.exact_decisions;
    if (best_) {
      const int sign = pairs_.distance.compareGaps(posed, pairs_.posed(*best_));
      if (sign > 0 || (sign == 0 && *best_ < candidate)) return;
      best_ = candidate;
      if (sign == 0) return;
    }
    best_ = candidate;
    best_gap_ = pairs_.distance.gap(posed);
    const bool zero =
        best_gap_ == 0.0 && pairs_.distance.compare(posed.p, posed.q, 0.0, -posed.radius_p, -posed.radius_q) == 0;
    best_high_ = zero ? 0.0 : std::nextafter(best_gap_, kInfinity);
    to_beat_ = tolerance_ > 0.0 ? std::nextafter(best_high_ - tolerance_, -kInfinity) : best_high_;
  }

  /// The same with the gap that float arithmetic computed, for answers without proof.
  void believe(PointPair candidate, double gap)
  {
    if (best_ && !(gap < best_gap_)) return;
    best_ = candidate;
    best_gap_ = best_high_ = to_beat_ = gap;
  }

  PairWalk walk_;
  PointPairs pairs_;
  const ScratchLease<PairStack> kept_stack_;
  std::vector<LanePair>& stack_ = (*kept_stack_).pairs;
  std::optional<PointPair> best_;
  double best_gap_ = kInfinity;  // of best_, rounded
  double best_high_ = kInfinity; // at least the gap of best_
  double to_beat_ = kInfinity;   // what is not nearer than this is passed over
  double tolerance_;
  bool proven_;
};

} // namespace

DistanceResult closestPairOnTarget(const Placed& a, const Placed& b, const Accuracy& accuracy)
{
  return ClosestSearch(a, b, accuracy).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(closestPairOnTarget);

DistanceResult closestPair(const Placed& a, const Placed& b, const DistanceRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  if (request.accuracy.stopsEarly()) {
    const IntervalFinding found = searchInterval(a, b, StopRule(request.accuracy), std::nullopt);
    const double gap = found.pair ? PointPairs(a, b, 0.0).gap(*found.pair) : std::numeric_limits<double>::infinity();
    return {gap, found.pair, found.distance, found.work};
  }
  return HWY_DYNAMIC_DISPATCH(closestPairOnTarget)(a, b, request.accuracy);
}

} // namespace pcl_bsh
#endif
