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

#include <pcl_bsh/traversal/visit_pairs-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A pair of lanes that may hold the smallest distance, and how deep they lie.
struct Open : LanePair {
  double lower; ///< no pair of points below is nearer; at least that of the pair it comes from
  std::uint32_t level_a = 0, level_b = 0;
};

bool laterThan(const Open& x, const Open& y)
{
  return x.lower > y.lower;
}

class IntervalSearch : public PairVisitor {
public:
  IntervalSearch(const Placed& a, const Placed& b, const StopRule& rule, std::optional<double> clearance,
                 const Watch& by)
  : PairVisitor(by),
    rule_(rule),
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
                 open_.push_back({pair, lowerOr(-kInfinity, walk_.lowerBound(pair, step, lane))});
               });
    if (!open_.empty()) measure(open_.front());
    if (rule_.deepest != StopRule::kNever)
      searchDepthFirst();
    else
      searchBestFirst();
    return conclude();
  }

  // As visitPairs() and expand() ask.

  double reach() const { return std::max(std::min(upper_, clearance_.value_or(kInfinity)), 0.0); }

  Next visit(const Open& open) const
  {
    return isSettled() ? Next::stop : matters(open.lower) ? Next::go_on : Next::prune;
  }

  /// Whether the rule lets a pair be opened; if not, it stays closed.
  bool opens(const Open& open, Opened opened)
  {
    const bool may_open = mayOpen(open, opened);
    if (!may_open) cut_lower_ = std::min(cut_lower_, open.lower);
    if (!may_open || isAboveVoxels(open)) measure(open); // the points that stand for it are others below
    return may_open;
  }

  bool keep(Open& child, Opened opened, const PairWalk::Step& step, std::uint32_t lane) const
  {
    child.lower = std::max(child.lower, lowerOr(child.lower, walk_.lowerBound(child, step, lane)));
    if (step.entered.space != kAboveVoxels) ++(opened == Opened::a ? child.level_a : child.level_b);
    return matters(child.lower);
  }

  Next compare(const Open& open)
  {
    const ComparedLeaves leaves = walk_.compare(open);
    const auto found = [&](std::uint32_t i, std::uint32_t j) {
      lowerTo({leaves.a.record(i), leaves.b.record(j)}, open.lower);
      if (isSettled()) cut_lower_ = std::min(cut_lower_, open.lower); // the rest is not looked at
      return isSettled();
    };
    eachPairMaybeNearest(leaves, pairs_.haveRadii(), std::min(upper_, clearance_.value_or(kInfinity)), found);
    return Next::go_on;
  }

private:
  /// Whether a lower bound leaves room for an answer not yet known.
  bool matters(double lower) const { return clearance_ ? lower <= *clearance_ : lower < upper_; }

  bool isSettled() const { return clearance_ && upper_ <= *clearance_; }

  /// Down to a level all pairs that matter are opened in any order, and a stack is cheaper than a heap.
  void searchDepthFirst()
  {
    nearestLast(open_, 0);
    visitPairs(walk_, open_, *this);
  }

  /// Within a budget, the pair with the smallest lower bound is opened first: it limits what can be proven.
  void searchBestFirst()
  {
    if (!open_.empty()) dive();
    std::make_heap(open_.begin(), open_.end(), laterThan);
    SearchPulse pulse({watch.progress}, open_.size());
    while (!open_.empty() && matters(open_.front().lower) && !isSettled() && !stop_check_.isOver()) {
      pulse.step(open_.size());
      std::pop_heap(open_.begin(), open_.end(), laterThan);
      const Open next = open_.back();
      open_.pop_back();
      measure(next);
      expand(walk_, next, step_, *this, [this](const Open& child) {
        open_.push_back(child);
        std::push_heap(open_.begin(), open_.end(), laterThan);
      });
    }
  }

  /// By the nearest children down to a first pair of points, for an upper bound to begin with. The others stay open.
  void dive()
  {
    nearestLast(open_, 0);
    std::optional<Open> nearest = open_.back();
    open_.pop_back();
    while (nearest) {
      const Open next = *nearest;
      nearest.reset();
      expand(walk_, next, step_, *this, [&](const Open& child) {
        if (nearest) open_.push_back(child.key < nearest->key ? *nearest : child);
        if (!nearest || child.key < nearest->key) nearest = child;
      });
    }
  }

  bool mayOpen(const Open& open, Opened opened) const
  {
    const Spaces& side = opened == Opened::a ? walk_.a : walk_.b;
    const Lane& lane = opened == Opened::a ? open.a : open.b;
    const Node& node = walk_.nodeOf(side, lane);
    if (lane.space == kAboveVoxels && !node.isLeaf(lane.lane)) return true;
    if ((opened == Opened::a ? open.level_a : open.level_b) >= rule_.deepest) return false;
    return lane.space != kAboveVoxels || rule_.leavesTimeToBuild(side.storage.pointsToBuild(node.begin[lane.lane]));
  }

  /// NaN is no bound.
  static double lowerOr(double otherwise, double bound) { return std::isnan(bound) ? otherwise : bound; }

  static bool isAboveVoxels(const LanePair& pair)
  {
    return pair.a.space == kAboveVoxels || pair.b.space == kAboveVoxels;
  }

  /// Takes some pair of points below the lanes for an upper bound.
  void measure(const Open& open)
  {
    if (isAboveVoxels(open)) return lowerTo(walk_.lowest(open), open.lower);
    const LeafRange a = walk_.leaf(walk_.a, open.a), b = walk_.leaf(walk_.b, open.b);
    const RelativeFrame& frame = walk_.frames.find(open.a.space, open.b.space);
    const Point p = carryPoint(frame.m.data(), frame.g.data(), {a.x()[0], a.y()[0], a.z()[0]});
    const double dx = static_cast<double>(p.x) - static_cast<double>(b.x()[0]);
    const double dy = static_cast<double>(p.y) - static_cast<double>(b.y()[0]);
    const double dz = static_cast<double>(p.z) - static_cast<double>(b.z()[0]);
    const double least = std::sqrt(dx * dx + dy * dy + dz * dz) - frame.error; // in b's units
    if (least * (1.0 - frame.skew()) * walk_.b.frame(open.b.space).unit - a.radius(0) - b.radius(0) < upper_)
      lowerTo({a.record(0), b.record(0)}, open.lower);
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
    upper_ = gap == 0.0 && !pairs_.mayOverlap() ? 0.0 : std::nextafter(gap, kInfinity);
    if (clearance_ && upper_ > *clearance_ && gap <= *clearance_ && pairs_.collide(candidate, walk_.work))
      upper_ = *clearance_;
  }

  IntervalFinding conclude()
  {
    IntervalFinding finding;
    double undecided = cut_lower_;
    for (const Open& open : open_) undecided = std::min(undecided, open.lower);
    finding.interval.upper = upper_;
    finding.interval.lower = std::min({undecided, pair_lower_, clearance_.value_or(kInfinity)});
    if (!pairs_.mayOverlap()) finding.interval.lower = std::max(finding.interval.lower, 0.0);
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
  PairWalk::Step step_;
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
                                       std::optional<double> clearance, const Watch& watch)
{
  return IntervalSearch(a, b, rule, clearance, watch).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(searchIntervalOnTarget);

IntervalFinding searchInterval(const Placed& a, const Placed& b, const StopRule& rule, std::optional<double> clearance,
                               const Watch& watch)
{
  return HWY_DYNAMIC_DISPATCH(searchIntervalOnTarget)(a, b, rule, clearance, watch);
}

} // namespace pcl_bsh
#endif
