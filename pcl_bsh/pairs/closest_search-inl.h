// SPDX-License-Identifier: BSD-3-Clause
// The search for the closest pair: depth first, nearest children first, until nothing left can be nearer.

#if defined(PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#undef PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#else
#define PCL_BSH_PAIRS_CLOSEST_SEARCH_INL_H_
#endif

#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/pairs/nearest.h>
#include <pcl_bsh/traversal/shared_stack.h>
#include <pcl_bsh/traversal/visit_pairs-inl.h>

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
///   nearer; `allow(pause)`: until when not to stop
template <class Others>
class ClosestSearch : public PairVisitor {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

public:
  ClosestSearch(const Placed& a, const Placed& b, const Accuracy& accuracy, Others others, const Watch& by = {})
  : PairVisitor(by),
    walk_(a, b),
    pairs_(a, b, 0.0),
    others_(std::move(others)),
    tolerance_(accuracy.mode == Accuracy::Mode::tolerance ? accuracy.value : 0.0)
  {
  }

  /// Searches until the end, or until it is stopped with pairs left().
  DistanceResult run()
  {
    stack_.clear();
    walk_.seed(kInfinity, [this](LanePair pair, const PairWalk::Step& step, std::uint32_t lane) {
      if (keep(pair, Opened::b, step, lane)) stack_.push_back(pair);
    });
    nearestLast(stack_, 0);
    visitPairs(walk_, stack_, *this);
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
    others_.allow({kStepsOfPiece, &piece.dropped});
    stack_.assign(piece.pairs.begin(), piece.pairs.end());
    visitPairs(walk_, stack_, *this);
    piece.pairs.assign(stack_.begin(), stack_.end());
    piece.work = std::exchange(walk_.work, Work());
  }

  const std::vector<LanePair>& left() const { return stack_; }

  /// Of what is known by now.
  DistanceResult result(const Work& work)
  {
    others_.hear(best_);
    return {best_.gap, best_.pair, interval(), work};
  }

  // As visitPairs() asks.

  /// Distances above this are of no interest.
  double reach() const { return std::max(best_.to_beat, 0.0); }

  Next visit(const LanePair& pair)
  {
    others_.hear(best_);
    if (!canImprove(pair)) return Next::prune;
    return others_.stops() ? Next::stop : Next::go_on;
  }

  bool keep(LanePair& pair, Opened, const PairWalk::Step& step, std::uint32_t lane) const
  {
    pair.key = walk_.boundKey(pair, step, lane);
    return canImprove(pair);
  }

  Next compare(const LanePair& pair)
  {
    const ComparedLeaves leaves = walk_.compare(pair);
    if (walk_.areTriangles()) {
      eachTrianglePairNear(
          leaves, walk_.a.storage.view, walk_.b.storage.view, walk_.flat(), [this] { return reach(); },
          [&](std::uint32_t i, std::uint32_t j) {
            consider({leaves.a.record(i), leaves.b.record(j)});
            return false;
          });
      return Next::go_on;
    }
    eachPairMaybeNearest(leaves, pairs_.haveRadii(), best_.to_beat, [&](std::uint32_t i, std::uint32_t j) {
      consider({leaves.a.record(i), leaves.b.record(j)});
      return false;
    });
    return Next::go_on;
  }

private:
  /// Nothing was passed over but what is no nearer than the best less the tolerance.
  Interval interval() const
  {
    if (!best_.pair) return {kInfinity, kInfinity};
    const double lower = std::nextafter(best_.gap, -kInfinity) - tolerance_;
    return {std::max(tolerance_ > 0.0 ? std::nextafter(lower, -kInfinity) : lower, static_cast<double>(lowestKey())),
            best_.high};
  }

  /// A pair is worth a visit if it may be nearer, or as near with smaller record numbers.
  bool canImprove(const LanePair& pair) const
  {
    const double bound = std::max(pair.key, lowestKey());
    if (bound < best_.to_beat) return true;
    if (bound > best_.to_beat || tolerance_ > 0.0) return false;
    return walk_.lowest(pair) < *best_.pair;
  }

  /// Without radii no distance is below 0, so that pairs at 0 are settled by their record numbers.
  float lowestKey() const { return pairs_.mayOverlap() ? -std::numeric_limits<float>::infinity() : 0.0f; }

  void consider(PointPair candidate)
  {
    const RecordDistance::Pair posed = pairs_.posed(candidate);
    ++walk_.work.exact_decisions;
    if (best_.pair && pairs_.ofTriangles() && pairs_.distance.isSurelyBeyond(posed, best_.high)) return;
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
    const bool zero = best_.gap == 0.0 && pairs_.distance.compare(posed, 0.0) == 0;
    best_.high = zero ? 0.0 : std::nextafter(best_.gap, kInfinity);
    best_.to_beat = tolerance_ > 0.0 ? std::nextafter(best_.high - tolerance_, -kInfinity) : best_.high;
    others_.tell(best_, pairs_);
  }

  PairWalk walk_;
  PointPairs pairs_;
  const ScratchLease<PairStack> kept_stack_;
  std::vector<LanePair>& stack_ = (*kept_stack_).pairs;
  Others others_;
  Nearest best_;
  double tolerance_;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
