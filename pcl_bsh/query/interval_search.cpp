// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/interval_search.h>
#include <pcl_bsh/query/stop_rule.h>

#include <algorithm>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/query/interval_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/query/pair_walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A pair of lanes that may hold the smallest distance, and how deep they lie.
struct Open {
  double lower; ///< no pair of points below is nearer; at least that of the pair it comes from
  LanePair pair;
  std::uint32_t level_a, level_b;
};

bool laterThan(const Open& x, const Open& y)
{
  return x.lower > y.lower;
}

class IntervalSearch {
public:
  IntervalSearch(const Placed& a, const Placed& b, const Accuracy& accuracy, std::optional<double> clearance)
  : rule_(accuracy),
    clearance_(clearance),
    walk_(a, b),
    pairs_(a, b, clearance.value_or(0.0))
  {
  }

  IntervalFinding run()
  {
    const double asked = clearance_.value_or(kInfinity);
    walk_.seed(asked, [this](const LanePair& pair, const PairWalk::Step& step, std::uint32_t lane) {
      push({walk_.lowerBound(pair, step, lane), pair, 0, 0});
    });
    if (clearance_) seen_lower_ = asked; // what seed() leaves out lies beyond
    if (!open_.empty()) measure(open_.front().pair);
    for (bool first = true; !open_.empty(); first = false) {
      const Open next = open_.front();
      if (!matters(next.lower) || isSettled() || isSpent()) break;
      std::pop_heap(open_.begin(), open_.end(), laterThan);
      open_.pop_back();
      visit(next, first);
    }
    return conclude();
  }

private:
  /// Whether a lower bound leaves room for an answer not yet known.
  bool matters(double lower) const { return clearance_ ? lower <= *clearance_ : lower < upper_; }

  bool isSettled() const { return clearance_ && upper_ <= *clearance_; }

  bool isSpent()
  {
    if (walk_.work.node_pairs >= rule_.node_pairs) return true;
    return rule_.isTimed() && steps_++ % 16 == 0 && rule_.isOver(); // a clock costs as much as a step
  }

  /// Opens a pair. The first one is followed down to points by its nearest children, for an upper bound to begin with.
  void visit(Open open, bool to_the_points)
  {
    for (;;) {
      const Opened opened = walk_.choose(open.pair);
      if (opened == Opened::neither) return compareLeaves(open);
      measure(open.pair);
      if (!mayOpen(open, opened)) {
        cut_lower_ = std::min(cut_lower_, open.lower);
        return;
      }
      PairWalk::Step step;
      walk_.step(open.pair, opened, std::max(std::min(upper_, clearance_.value_or(kInfinity)), 0.0), step);
      std::optional<Open> nearest;
      for (std::uint32_t near = step.near; near != 0; near &= near - 1) {
        const Open child = childOf(open, opened, step, static_cast<std::uint32_t>(std::countr_zero(near)));
        if (!matters(child.lower)) continue;
        if (!to_the_points) {
          push(child);
          continue;
        }
        if (nearest && nearest->pair.key <= child.pair.key) {
          push(child);
          continue;
        }
        if (nearest) push(*nearest);
        nearest = child;
      }
      if (!nearest) return;
      open = *nearest;
    }
  }

  Open childOf(const Open& open, Opened opened, const PairWalk::Step& step, std::uint32_t lane) const
  {
    const double lower = walk_.lowerBound(open.pair, step, lane);
    return {std::isnan(lower) ? open.lower : std::max(lower, open.lower),
            PairWalk::childOf(open.pair, opened, step, lane),
            open.level_a + (opened == Opened::a && isBelowVoxels(step) ? 1 : 0),
            open.level_b + (opened == Opened::b && isBelowVoxels(step) ? 1 : 0)};
  }

  static bool isBelowVoxels(const PairWalk::Step& step) { return step.entered.space != kAboveVoxels; }

  bool mayOpen(const Open& open, Opened opened) const
  {
    const Spaces& side = opened == Opened::a ? walk_.a : walk_.b;
    const Lane& lane = opened == Opened::a ? open.pair.a : open.pair.b;
    const Node& node = walk_.nodeOf(side, lane);
    if (lane.space == kAboveVoxels && !node.isLeaf(lane.lane)) return true;
    if ((opened == Opened::a ? open.level_a : open.level_b) >= rule_.deepest) return false;
    return lane.space != kAboveVoxels || rule_.leavesTimeToBuild(side.storage.pointsToBuild(node.begin[lane.lane]));
  }

  void push(const Open& open)
  {
    open_.push_back(open);
    if (std::isnan(open.lower)) open_.back().lower = -kInfinity;
    std::push_heap(open_.begin(), open_.end(), laterThan);
  }

  /// Takes some pair of points below the lanes for an upper bound.
  void measure(const LanePair& pair)
  {
    if (pair.a.space == kAboveVoxels || pair.b.space == kAboveVoxels) {
      lowerTo({lowest(walk_.a, pair.a), lowest(walk_.b, pair.b)});
      return;
    }
    const LeafRange a = walk_.leaf(walk_.a, pair.a), b = walk_.leaf(walk_.b, pair.b);
    const RelativeFrame& frame = walk_.frames.find(pair.a.space, pair.b.space);
    const Point p = carryPoint(frame.m.data(), frame.g.data(), {a.x()[0], a.y()[0], a.z()[0]});
    const double dx = static_cast<double>(p.x) - static_cast<double>(b.x()[0]);
    const double dy = static_cast<double>(p.y) - static_cast<double>(b.y()[0]);
    const double dz = static_cast<double>(p.z) - static_cast<double>(b.z()[0]);
    const double least = std::sqrt(dx * dx + dy * dy + dz * dz) - frame.error; // in b's units
    if (least * (1.0 - frame.skew()) * walk_.b.frame(pair.b.space).unit - a.radius(0) - b.radius(0) < upper_)
      lowerTo({a.record(0), b.record(0)});
  }

  std::uint32_t lowest(const Spaces& side, const Lane& lane) const
  {
    return walk_.nodeOf(side, lane).lowest[lane.lane];
  }

  /// Lowers the upper bound to the gap of a pair, if that is less. @return a lower bound of the gap
  double lowerTo(PointPair candidate)
  {
    ++walk_.work.exact_decisions;
    const double gap = pairs_.gap(candidate);
    const bool zero = gap == 0.0 && !pairs_.haveRadii();
    const double upper = zero ? 0.0 : std::nextafter(gap, kInfinity);
    if (upper < upper_ || !pair_) {
      upper_ = upper;
      pair_ = candidate;
    }
    if (clearance_ && upper > *clearance_ && gap <= *clearance_ && pairs_.collide(candidate, walk_.work))
      collide(candidate);
    return zero ? 0.0 : std::nextafter(gap, -kInfinity);
  }

  void collide(PointPair candidate)
  {
    upper_ = *clearance_;
    pair_ = candidate;
  }

  void compareLeaves(const Open& open)
  {
    ++walk_.work.leaf_pairs;
    const LeafRange a = walk_.leaf(walk_.a, open.pair.a), b = walk_.leaf(walk_.b, open.pair.b);
    const RelativeFrame& frame = walk_.frames.find(open.pair.a.space, open.pair.b.space);
    LeafPoints points;
    carryLeaf(frame, a, points);
    const double asked = std::min(upper_, clearance_.value_or(kInfinity));
    const auto found = [&](std::uint32_t i, std::uint32_t j, float) {
      seen_lower_ = std::min(seen_lower_, std::max(open.lower, lowerTo({a.record(i), b.record(j)})));
      return isSettled();
    };
    if (pairs_.haveRadii()) {
      eachBallPairNear(frame, points, firstBits(a.count), a, b, asked, found);
      return;
    }
    // Only pairs that float arithmetic may call nearest are worth an exact look.
    alignas(64) float nearest[kLeafPoints];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
    nearestSquared(points, b.x(), b.y(), b.z(), b.count, nearest);
    const float least = *std::min_element(nearest, nearest + a.count);
    const double within = (std::sqrt(static_cast<double>(least)) * (1.0 + 0x1p-20) + frame.error) *
                          (1.0 + frame.skew()) * walk_.b.frame(open.pair.b.space).unit;
    const float miss =
        frame.band(std::isnan(within) ? std::max(asked, 0.0) : std::min(within, std::max(asked, 0.0))).miss;
    const std::uint32_t lanes = firstBits(a.count) & ~above(nearest, miss);
    if (lanes != 0) eachPairNotBeyond(points, lanes, b, miss, found);
  }

  IntervalFinding conclude()
  {
    IntervalFinding finding;
    const double open = open_.empty() ? kInfinity : open_.front().lower;
    const double undecided = std::min(cut_lower_, open);
    finding.distance.upper = upper_;
    finding.distance.lower = std::min({undecided, seen_lower_, upper_});
    if (!pairs_.haveRadii()) finding.distance.lower = std::max(finding.distance.lower, 0.0);
    finding.pair = pair_;
    if (clearance_) {
      finding.verdict = isSettled() ? Verdict::colliding : undecided > *clearance_ ? Verdict::free : Verdict::undecided;
    }
    finding.work = walk_.work;
    return finding;
  }

  StopRule rule_;
  const std::optional<double> clearance_;
  PairWalk walk_;
  PointPairs pairs_;
  std::vector<Open> open_; // a heap, the least lower bound first
  std::optional<PointPair> pair_;
  double upper_ = kInfinity;      // at least the gap of pair_
  double cut_lower_ = kInfinity;  // of what was not to be opened
  double seen_lower_ = kInfinity; // of the pairs of points that were looked at
  std::uint64_t steps_ = 0;
};

} // namespace

IntervalFinding searchIntervalOnTarget(const Placed& a, const Placed& b, const Accuracy& accuracy,
                                       std::optional<double> clearance)
{
  return IntervalSearch(a, b, accuracy, clearance).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(searchIntervalOnTarget);

IntervalFinding searchInterval(const Placed& a, const Placed& b, const Accuracy& accuracy,
                               std::optional<double> clearance)
{
  return HWY_DYNAMIC_DISPATCH(searchIntervalOnTarget)(a, b, accuracy, clearance);
}

} // namespace pcl_bsh
#endif
