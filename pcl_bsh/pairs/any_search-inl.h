// SPDX-License-Identifier: BSD-3-Clause
// The search for any colliding pair: depth first, nearest children first, done at the first witness.

#if defined(PCL_BSH_PAIRS_ANY_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_PAIRS_ANY_SEARCH_INL_H_
#undef PCL_BSH_PAIRS_ANY_SEARCH_INL_H_
#else
#define PCL_BSH_PAIRS_ANY_SEARCH_INL_H_
#endif

#include <pcl_bsh/query/acceptance.h>
#include <pcl_bsh/traversal/leaf_pair-inl.h>
#include <pcl_bsh/traversal/pair_walk-inl.h>
#include <pcl_bsh/traversal/shared_stack.h>

#include <algorithm>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// An observer that does nothing: its calls compile to nothing.
struct NoObserver {
  void seeded(const LanePair&) {}
  void stepped(const LanePair&, Opened, const PairWalk::Step&) {}
  void compared(const LanePair&) {}
  static bool stops(const PairWalk&, const LanePair&, Opened) { return false; }
};

inline AnyResult resultOf(const Acceptance& acceptance, const std::optional<PointPair>& witness, bool stopped,
                          const Work& work)
{
  AnyResult result;
  result.witness = witness;
  result.work = work;
  result.verdict = witness ? Verdict::colliding : stopped ? Verdict::undecided : Verdict::free;
  if (acceptance.proven && result.verdict != Verdict::undecided)
    (witness ? result.distance.upper : result.distance.lower) =
        witness ? acceptance.surely_within : acceptance.surely_beyond;
  return result;
}

/// @tparam Observer is called with the pairs of the roots' children that may meet (seeded), with each pair whose larger
///   side was opened and the test of its children (stepped), with each pair of leaves whose points were compared
///   (compared), and before each pair is opened, whether to stop there (stops)
template <class Observer>
class AnySearch {
public:
  AnySearch(const Placed& a, const Placed& b, const AnyRequest& request, Observer observer,
            Places places = Places::measured)
  : walk_(a, b),
    pairs_(a, b, request.clearance, places),
    acceptance_(pairs_.reach, request.accuracy),
    observer_(std::move(observer))
  {
    walk_.accepted_beyond = acceptance_.accepted - acceptance_.clearance;
    if (walk_.accepted_beyond < 0.0) walk_.accepted_beyond -= kDoubleMargin * acceptance_.clearance;
  }

  AnyResult run()
  {
    stack_.clear();
    walk_.seed(pairs_.clearance, [this](const LanePair& pair, const PairWalk::Step&, std::uint32_t) {
      observer_.seeded(pair);
      stack_.push_back(pair);
    });
    nearestLast(stack_, 0);
    const std::optional<PointPair> witness = search();
    return resultOf(acceptance_, witness, stopped_, walk_.work);
  }

  /// Visits the pairs of a piece and what is below, until a witness is found or the observer stops.
  void visit(SharedStack<LanePair>::Piece& piece)
  {
    stack_.assign(piece.pairs.begin(), piece.pairs.end());
    piece.found = search();
    piece.pairs.assign(stack_.begin(), stack_.end());
    piece.work = std::exchange(walk_.work, Work());
  }

  /// Looks below these pairs alone, the last one first. @pre their nodes' voxels are built
  std::optional<PointPair> searchBelow(const std::vector<LanePair>& pairs)
  {
    stack_.assign(pairs.begin(), pairs.end());
    return search();
  }

  const Work& work() const { return walk_.work; }

  /// What is left to be visited since the observer stopped the search, the next one last.
  const std::vector<LanePair>& left() const { return stack_; }

private:
  std::optional<PointPair> search()
  {
    stopped_ = false;
    PairWalk::Step step;
    while (!stack_.empty()) {
      const LanePair pair = stack_.back();
      stack_.pop_back();
      const Opened opened = walk_.choose(pair);
      if (observer_.stops(walk_, pair, opened)) {
        stopped_ = true;
        stack_.push_back(pair);
        return std::nullopt;
      }
      if (opened == Opened::neither) {
        if (const auto witness = compareLeaves(pair)) return witness;
        continue;
      }
      walk_.step(pair, opened, pairs_.clearance, step);
      observer_.stepped(pair, opened, step);
      if (step.inside != 0) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(step.inside));
        const LanePair inside = PairWalk::childOf(pair, opened, step, lane);
        return PointPair{firstRecord(walk_.a, inside.a), firstRecord(walk_.b, inside.b)};
      }
      const std::size_t from = stack_.size();
      for (std::uint32_t near = step.near; near != 0; near &= near - 1)
        stack_.push_back(PairWalk::childOf(pair, opened, step, static_cast<std::uint32_t>(std::countr_zero(near))));
      nearestLast(stack_, from);
    }
    return std::nullopt;
  }

  std::optional<PointPair> compareLeaves(const LanePair& pair)
  {
    ++walk_.work.leaf_pairs;
    observer_.compared(pair);
    const LeafRange a = walk_.leaf(walk_.a, pair.a), b = walk_.leaf(walk_.b, pair.b);
    const RelativeFrame& frame = walk_.frames.find(pair.a.space, pair.b.space);
    LeafPoints points;
    carryLeaf(frame, a, points);
    const std::uint32_t lanes =
        pointsNearLeaf(frame, points, a, walk_.nodeOf(walk_.b, pair.b), pair.b.lane, pairs_.clearance);
    if (lanes == 0) return std::nullopt;

    std::optional<PointPair> witness;
    const auto found = [&](std::uint32_t i, std::uint32_t j, bool surely) {
      const PointPair candidate{a.record(i), b.record(j)};
      if (surely || pairs_.collide(candidate, walk_.work)) witness = candidate;
      return witness.has_value();
    };
    if (pairs_.haveRadii()) {
      eachBallPairNear(frame, points, lanes, a, b, pairs_.clearance, pairs_.reach.least,
                       [&](std::uint32_t i, std::uint32_t j, float, bool surely) { return found(i, j, surely); });
    }
    else {
      const DistanceBand band = acceptance_.band(frame);
      alignas(64) float nearest[kLeafPoints];
      std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
      nearestSquared(points, b.x(), b.y(), b.z(), firstBits(b.count), nearest);
      eachPairNotBeyond(
          points, lanes & ~above(nearest, band.miss), b, band.miss,
          [&](std::uint32_t i, std::uint32_t j, float squared) { return found(i, j, squared <= band.hit); });
    }
    return witness;
  }

  std::uint32_t firstRecord(const Spaces& side, const Lane& lane)
  {
    const std::uint32_t begin = walk_.nodeOf(side, lane).begin[lane.lane];
    if (lane.space != kAboveVoxels) return side.storage.voxels[lane.space].records()[begin];
    return side.voxel(begin, walk_.work).records()[0];
  }

  PairWalk walk_;
  PointPairs pairs_;
  Acceptance acceptance_;
  Observer observer_;
  bool stopped_ = false;
  const ScratchLease<PairStack> kept_stack_;
  std::vector<LanePair>& stack_ = (*kept_stack_).pairs;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
