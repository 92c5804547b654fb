// SPDX-License-Identifier: BSD-3-Clause
// The closest pair: one dive for an upper bound, then best first until nothing left can be nearer.
#include <pcl_bsh/query/collide.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/query/closest_pair.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/query/pair_walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class ClosestSearch {
public:
  ClosestSearch(const Placed& a, const Placed& b) : walk_(a, b), pairs_(a, b, 0.0) {}

  DistanceResult run()
  {
    walk_.seed(kInfinity, [this](LanePair pair) {
      pair.key = lowerBound(pair);
      push(pair);
    });
    dive();
    while (!heap_.empty()) {
      const LanePair pair = pop();
      if (canImprove(pair)) visit(pair, [this](const LanePair& child) { push(child); });
    }
    return {best_gap_, best_, walk_.work};
  }

private:
  /// Follows the nearest children down to two leaves, for a first upper bound. What it passes by goes to the heap.
  void dive()
  {
    if (heap_.empty()) return;
    LanePair pair = pop();
    while (walk_.choose(pair) != Opened::neither) {
      std::vector<LanePair> children;
      visit(pair, [&](const LanePair& child) { children.push_back(child); });
      const auto nearest =
          std::min_element(children.begin(), children.end(), [this](const LanePair& l, const LanePair& r) {
            return centerDistance(l) < centerDistance(r);
          });
      pair = *nearest;
      children.erase(nearest);
      for (const LanePair& child : children) push(child);
    }
    compareLeaves(pair);
  }

  template <class Child>
  void visit(const LanePair& pair, const Child& child)
  {
    const Opened opened = walk_.choose(pair);
    if (opened == Opened::neither) return compareLeaves(pair);
    PairWalk::Step step;
    walk_.step(pair, opened, clearanceToBeat(), step);
    for (std::uint32_t near = step.near; near != 0; near &= near - 1) {
      LanePair below = PairWalk::childOf(pair, opened, step, static_cast<std::uint32_t>(std::countr_zero(near)));
      below.key = lowerBound(below);
      if (canImprove(below)) child(below);
    }
  }

  /// Distances above this are of no interest.
  double clearanceToBeat() const { return std::max(best_high_, 0.0); }

  /// A pair is worth a visit if it may be nearer, or as near with smaller record numbers.
  bool canImprove(const LanePair& pair) const
  {
    if (!(static_cast<double>(pair.key) >= best_high_)) return true;
    if (static_cast<double>(pair.key) > best_high_) return false;
    return PointPair{lowest(walk_.a, pair.a), lowest(walk_.b, pair.b)} < *best_;
  }

  std::uint32_t lowest(const Spaces& side, const Lane& lane) const
  {
    return walk_.nodeOf(side, lane).lowest[lane.lane];
  }

  /// Distance of the centres, in the clouds' unit, and its error.
  double centerDistance(const LanePair& pair)
  {
    const RelativeFrame& frame = walk_.frames.find(pair.a.space, pair.b.space);
    const Node &a = walk_.nodeOf(walk_.a, pair.a), &b = walk_.nodeOf(walk_.b, pair.b);
    const Point c = carriedCenter(frame, a, pair.a.lane);
    const double dx = static_cast<double>(c.x) - static_cast<double>(b.x[pair.b.lane]);
    const double dy = static_cast<double>(c.y) - static_cast<double>(b.y[pair.b.lane]);
    const double dz = static_cast<double>(c.z) - static_cast<double>(b.z[pair.b.lane]);
    return std::sqrt(dx * dx + dy * dy + dz * dz) * walk_.b.frame(pair.b.space).unit;
  }

  /// No pair of points below is nearer than this; may be negative.
  float lowerBound(const LanePair& pair)
  {
    const RelativeFrame& frame = walk_.frames.find(pair.a.space, pair.b.space);
    const Node &a = walk_.nodeOf(walk_.a, pair.a), &b = walk_.nodeOf(walk_.b, pair.b);
    const double unit = walk_.b.frame(pair.b.space).unit;
    const double reach = (static_cast<double>(a.r[pair.a.lane]) * static_cast<double>(frame.stretch_a) +
                          static_cast<double>(b.r[pair.b.lane]) * static_cast<double>(frame.stretch_b) +
                          static_cast<double>(frame.pruneReach(0.0))) *
                         unit;
    const double bound = (centerDistance(pair) * (1.0 - 0x1p-40) - reach * (1.0 + 0x1p-40)) * (1.0 - frame.skew());
    return std::isnan(bound) ? -std::numeric_limits<float>::infinity() : std::max(roundDownToFloat(bound), lowestKey());
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
    const auto found = [&](std::uint32_t i, std::uint32_t j, float) {
      consider({a.record(i), b.record(j)});
      return false;
    };
    if (pairs_.haveRadii()) {
      eachBallPairNear(frame, points, firstBits(a.count), a, b, best_high_, found);
      return;
    }
    // The nearest pair in float bounds what is worth an exact look.
    alignas(64) float nearest[kLeafPoints];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
    nearestSquared(points, b.x(), b.y(), b.z(), b.count, nearest);
    const float least = *std::min_element(nearest, nearest + a.count);
    const double unit = walk_.b.frame(pair.b.space).unit;
    const double within =
        (std::sqrt(static_cast<double>(least)) * (1.0 + 0x1p-20) + frame.error) * (1.0 + frame.skew()) * unit;
    const double to_beat = std::isnan(within) ? clearanceToBeat() : std::min(within, clearanceToBeat());
    const float miss = frame.band(to_beat).miss;
    const std::uint32_t lanes = firstBits(a.count) & ~above(nearest, miss);
    if (lanes != 0) eachPairNotBeyond(points, lanes, b, miss, found);
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
  }

  static bool after(const LanePair& left, const LanePair& right) { return left.key > right.key; }

  void push(const LanePair& pair)
  {
    heap_.push_back(pair);
    std::push_heap(heap_.begin(), heap_.end(), after);
  }

  LanePair pop()
  {
    std::pop_heap(heap_.begin(), heap_.end(), after);
    const LanePair pair = heap_.back();
    heap_.pop_back();
    return pair;
  }

  PairWalk walk_;
  PointPairs pairs_;
  std::vector<LanePair> heap_;
  std::optional<PointPair> best_;
  double best_gap_ = kInfinity;  // of best_, rounded
  double best_high_ = kInfinity; // at least the gap of best_
};

} // namespace

DistanceResult closestPairOnTarget(const Placed& a, const Placed& b)
{
  return ClosestSearch(a, b).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(closestPairOnTarget);

DistanceResult closestPair(const Placed& a, const Placed& b, const CollisionRequest& request)
{
  check(a, b, request);
  return HWY_DYNAMIC_DISPATCH(closestPairOnTarget)(a, b);
}

} // namespace pcl_bsh
#endif
