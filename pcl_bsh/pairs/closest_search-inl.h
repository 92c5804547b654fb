// SPDX-License-Identifier: BSD-3-Clause
// The search for the closest pair: depth first, nearest children first, until nothing left can be nearer. (A heap of
// pairs, best first, visits as many nodes and spends more than half of the time on itself.)

#if defined(PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#undef PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#else
#define PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#endif

#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/pairs/nearest.h>
#include <pcl_bsh/traversal/pair_walk-inl.h>
#include <pcl_bsh/traversal/shared_stack.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

namespace { // the search is inlined where it is its translation unit's own

/// No other thread searches. Its calls compile to nothing.
struct NoOthers {
  static bool stops() { return false; }
  static void hear(Nearest&) {}
  static void tell(Nearest&, const PointPairs&) {}
};

} // namespace

/// @tparam Others the searches of other threads: `stops()` before each pair is visited, whether to pause there;
///   `hear(nearest)`: takes over what they have found; `tell(nearest, pairs)`: gives it to them, and takes what is
///   nearer; `allow(steps, dropped)`: until when not to stop
template <class Others>
class ClosestSearch {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

public:
  ClosestSearch(const Placed& a, const Placed& b, const Accuracy& accuracy, Others others)
  : walk_(a, b),
    pairs_(a, b, 0.0),
    others_(std::move(others)),
    tolerance_(accuracy.mode == Accuracy::Mode::tolerance ? accuracy.value : 0.0),
    proven_(accuracy.isProven())
  {
  }

  /// Searches until the end, or until it is stopped with pairs left().
  DistanceResult run()
  {
    stack_.clear();
    walk_.seed(kInfinity, [this](const LanePair& pair, const PairWalk::Step& step, std::uint32_t lane) {
      push(pair, step, lane);
    });
    nearestLast(stack_, 0);
    search();
    return result(walk_.work);
  }

  /// The same with a bound on the distance from the start: that of any pair.
  DistanceResult runFrom(PointPair pair)
  {
    consider(pair);
    return run();
  }

  /// Visits the pairs of a piece and what is below, until it is stopped.
  void operator()(SharedStack<LanePair>::Piece& piece)
  {
    others_.allow(kStepsOfPiece, &piece.dropped);
    stack_.assign(piece.pairs.begin(), piece.pairs.end());
    search();
    piece.pairs.assign(stack_.begin(), stack_.end());
    piece.work = std::exchange(walk_.work, Work());
  }

  const std::vector<LanePair>& left() const { return stack_; }

  /// Of what is known by now.
  DistanceResult result(const Work& work)
  {
    others_.hear(best_);
    return {best_.gap, best_.pair, proven_ ? interval() : Interval{}, work};
  }

private:
  void search()
  {
    while (!stack_.empty()) {
      others_.hear(best_);
      const LanePair pair = stack_.back();
      if (!canImprove(pair)) {
        stack_.pop_back();
        continue;
      }
      if (others_.stops()) return;
      stack_.pop_back();
      visit(pair);
    }
  }

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
    if (!best_.pair) return {kInfinity, kInfinity};
    const double lower = std::nextafter(best_.gap, -kInfinity) - tolerance_;
    return {std::max(tolerance_ > 0.0 ? std::nextafter(lower, -kInfinity) : lower, static_cast<double>(lowestKey())),
            best_.high};
  }

  /// Distances above this are of no interest.
  double clearanceToBeat() const { return std::max(best_.to_beat, 0.0); }

  /// A pair is worth a visit if it may be nearer, or as near with smaller record numbers.
  bool canImprove(const LanePair& pair) const
  {
    const double bound = std::max(pair.key, lowestKey());
    if (bound < best_.to_beat) return true;
    if (bound > best_.to_beat || tolerance_ > 0.0) return false;
    return PointPair{lowest(walk_.a, pair.a), lowest(walk_.b, pair.b)} < *best_.pair;
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
      eachBallPairNear(frame, points, firstBits(a.count), a, b, best_.to_beat, -kInfinity,
                       [&](std::uint32_t i, std::uint32_t j, float squared, bool) { return found(i, j, squared); });
      return;
    }
    eachPairMaybeNearest(frame, points, a, b, unit, clearanceToBeat(), found);
  }

  void consider(PointPair candidate)
  {
    const ExactDistance::Pair posed = pairs_.posed(candidate);
    ++walk_.work.exact_decisions;
    if (best_.pair) {
      const int sign = pairs_.distance.compareGaps(posed, pairs_.posed(*best_.pair));
      if (sign > 0 || (sign == 0 && *best_.pair < candidate)) return;
      if (sign == 0) {
        best_.pair = candidate;
        others_.tell(best_, pairs_);
        return;
      }
    }
    best_.pair = candidate;
    best_.gap = pairs_.distance.gap(posed);
    const bool zero =
        best_.gap == 0.0 && pairs_.distance.compare(posed.p, posed.q, 0.0, -posed.radius_p, -posed.radius_q) == 0;
    best_.high = zero ? 0.0 : std::nextafter(best_.gap, kInfinity);
    best_.to_beat = tolerance_ > 0.0 ? std::nextafter(best_.high - tolerance_, -kInfinity) : best_.high;
    others_.tell(best_, pairs_);
  }

  /// The same with the gap that float arithmetic computed, for answers without proof.
  void believe(PointPair candidate, double gap)
  {
    if (best_.pair && !(gap < best_.gap)) return;
    best_.pair = candidate;
    best_.gap = best_.high = best_.to_beat = gap;
  }

  PairWalk walk_;
  PointPairs pairs_;
  const ScratchLease<PairStack> kept_stack_;
  std::vector<LanePair>& stack_ = (*kept_stack_).pairs;
  Others others_;
  Nearest best_;
  double tolerance_;
  bool proven_;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
