// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/pairs/interval_search.h>
#include <pcl_bsh/query/stop_rule.h>

#include <algorithm>
#include <cmath>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/interval_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/traversal/pair_walk-inl.h>

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
  IntervalSearch(const Placed& a, const Placed& b, const StopRule& rule, std::optional<double> clearance)
  : rule_(rule),
    clearance_(clearance),
    walk_(a, b),
    stop_check_(rule_, walk_.work.node_pairs),
    pairs_(a, b, clearance.value_or(0.0))
  {
  }

  IntervalFinding run()
  {
    walk_.seed(clearance_.value_or(kInfinity),
               [this](const LanePair& pair, const PairWalk::Step& step, std::uint32_t lane) {
                 open_.push_back({lowerOr(-kInfinity, walk_.lowerBound(pair, step, lane)), pair, 0, 0});
               });
    if (!open_.empty()) measure(open_.front());
    if (rule_.deepest != StopRule::kNever)
      searchDepthFirst();
    else
      searchBestFirst();
    return conclude();
  }

private:
  /// Whether a lower bound leaves room for an answer not yet known.
  bool matters(double lower) const { return clearance_ ? lower <= *clearance_ : lower < upper_; }

  bool isSettled() const { return clearance_ && upper_ <= *clearance_; }

  /// Down to a level all pairs that matter are opened in any order, and a stack is cheaper than a heap.
  void searchDepthFirst()
  {
    nearestLast(0);
    while (!open_.empty() && !isSettled()) {
      const Open next = open_.back();
      open_.pop_back();
      if (!matters(next.lower)) continue;
      const std::size_t from = open_.size();
      expand(next, [this](const Open& child) { open_.push_back(child); });
      nearestLast(from);
    }
  }

  /// Within a budget, the pair with the smallest lower bound is opened first: it limits what can be proven.
  void searchBestFirst()
  {
    if (!open_.empty()) dive();
    std::make_heap(open_.begin(), open_.end(), laterThan);
    while (!open_.empty() && matters(open_.front().lower) && !isSettled() && !stop_check_.isOver()) {
      std::pop_heap(open_.begin(), open_.end(), laterThan);
      const Open next = open_.back();
      open_.pop_back();
      measure(next);
      expand(next, [this](const Open& child) {
        open_.push_back(child);
        std::push_heap(open_.begin(), open_.end(), laterThan);
      });
    }
  }

  /// By the nearest children down to a first pair of points, for an upper bound to begin with. The others stay open.
  void dive()
  {
    nearestLast(0);
    std::optional<Open> nearest = open_.back();
    open_.pop_back();
    while (nearest) {
      const Open next = *nearest;
      nearest.reset();
      expand(next, [&](const Open& child) {
        if (nearest) open_.push_back(child.pair.key < nearest->pair.key ? *nearest : child);
        if (!nearest || child.pair.key < nearest->pair.key) nearest = child;
      });
    }
  }

  /// Compares two leaves; or opens a pair and calls take() with those of its children that matter; or leaves the pair
  /// closed where the rule does not let it be opened.
  template <class Take>
  void expand(const Open& open, const Take& take)
  {
    const Opened opened = walk_.choose(open.pair);
    if (opened == Opened::neither) return compareLeaves(open);
    if (!mayOpen(open, opened)) {
      measure(open);
      cut_lower_ = std::min(cut_lower_, open.lower);
      return;
    }
    if (isAboveVoxels(open.pair)) measure(open); // the points that stand for it are others below
    PairWalk::Step step;
    walk_.step(open.pair, opened, std::max(std::min(upper_, clearance_.value_or(kInfinity)), 0.0), step);
    for (std::uint32_t near = step.near; near != 0; near &= near - 1) {
      const Open child = childOf(open, opened, step, static_cast<std::uint32_t>(std::countr_zero(near)));
      if (matters(child.lower)) take(child);
    }
  }

  Open childOf(const Open& open, Opened opened, const PairWalk::Step& step, std::uint32_t lane) const
  {
    const LanePair child = PairWalk::childOf(open.pair, opened, step, lane);
    return {std::max(open.lower, lowerOr(open.lower, walk_.lowerBound(child, step, lane))), child,
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

  /// NaN is no bound.
  static double lowerOr(double otherwise, double bound) { return std::isnan(bound) ? otherwise : bound; }

  /// Orders what was opened last by nearness, the nearest to be taken first.
  void nearestLast(std::size_t from)
  {
    std::stable_sort(open_.begin() + static_cast<std::ptrdiff_t>(from), open_.end(),
                     [](const Open& x, const Open& y) { return x.pair.key > y.pair.key; });
  }

  static bool isAboveVoxels(const LanePair& pair)
  {
    return pair.a.space == kAboveVoxels || pair.b.space == kAboveVoxels;
  }

  /// Takes some pair of points below the lanes for an upper bound.
  void measure(const Open& open)
  {
    const LanePair& pair = open.pair;
    if (isAboveVoxels(pair)) {
      lowerTo({lowest(walk_.a, pair.a), lowest(walk_.b, pair.b)}, open.lower);
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
      lowerTo({a.record(0), b.record(0)}, open.lower);
  }

  std::uint32_t lowest(const Spaces& side, const Lane& lane) const
  {
    return walk_.nodeOf(side, lane).lowest[lane.lane];
  }

  /// Lowers the upper bound to the gap of a pair, if that is less. @param lower bounds the gap from below
  void lowerTo(PointPair candidate, double lower)
  {
    ++walk_.work.exact_decisions;
    if (pair_ && !pairs_.isNearer(candidate, upper_)) return;
    const double gap = pairs_.gap(candidate);
    if (pair_ && gap > gap_) return; // nearer than the bound, which is rounded, but not than the pair
    const double gap_lower = std::max(lower, std::nextafter(gap, -kInfinity));
    pair_lower_ = pair_ && gap == gap_ ? std::min(pair_lower_, gap_lower) : gap_lower;
    pair_ = candidate;
    gap_ = gap;
    upper_ = gap == 0.0 && !pairs_.haveRadii() ? 0.0 : std::nextafter(gap, kInfinity);
    if (clearance_ && upper_ > *clearance_ && gap <= *clearance_ && pairs_.collide(candidate, walk_.work))
      upper_ = *clearance_;
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
      lowerTo({a.record(i), b.record(j)}, open.lower);
      if (isSettled()) cut_lower_ = std::min(cut_lower_, open.lower); // the rest is not looked at
      return isSettled();
    };
    if (pairs_.haveRadii()) {
      eachBallPairNear(frame, points, firstBits(a.count), a, b, asked, -kInfinity,
                       [&](std::uint32_t i, std::uint32_t j, float squared, bool) { return found(i, j, squared); });
      return;
    }
    eachPairMaybeNearest(frame, points, a, b, walk_.b.frame(open.pair.b.space).unit, std::max(asked, 0.0), found);
  }

  IntervalFinding conclude()
  {
    IntervalFinding finding;
    double undecided = cut_lower_;
    for (const Open& open : open_) undecided = std::min(undecided, open.lower);
    finding.distance.upper = upper_;
    finding.distance.lower = std::min({undecided, pair_lower_, clearance_.value_or(kInfinity)});
    if (!pairs_.haveRadii()) finding.distance.lower = std::max(finding.distance.lower, 0.0);
    finding.pair = pair_;
    if (clearance_) {
      finding.verdict = isSettled() ? Verdict::colliding : undecided > *clearance_ ? Verdict::free : Verdict::undecided;
    }
    finding.work = walk_.work;
    return finding;
  }

  const StopRule rule_;
  const std::optional<double> clearance_;
  PairWalk walk_;
  StopCheck stop_check_;
  PointPairs pairs_;
  std::vector<Open> open_; // a stack, the nearest last, or a heap, the least lower bound first
  std::optional<PointPair> pair_;
  double gap_ = kInfinity;        // of pair_, rounded to the nearest double
  double pair_lower_ = kInfinity; // at most the gap of pair_, the least of all that were looked at
  double upper_ = kInfinity;      // at least the gap of pair_
  double cut_lower_ = kInfinity;  // of what was not to be opened
};

} // namespace

IntervalFinding searchIntervalOnTarget(const Placed& a, const Placed& b, const StopRule& rule,
                                       std::optional<double> clearance)
{
  return IntervalSearch(a, b, rule, clearance).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(searchIntervalOnTarget);

IntervalFinding searchInterval(const Placed& a, const Placed& b, const StopRule& rule, std::optional<double> clearance)
{
  return HWY_DYNAMIC_DISPATCH(searchIntervalOnTarget)(a, b, rule, clearance);
}

} // namespace pcl_bsh
#endif
