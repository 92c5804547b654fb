// SPDX-License-Identifier: BSD-3-Clause
// The search for any colliding pair: depth first, nearest children first, done at the first witness.

#if defined(PCL_BSH_PAIRS_ANY_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_PAIRS_ANY_SEARCH_INL_H_
#undef PCL_BSH_PAIRS_ANY_SEARCH_INL_H_
#else
#define PCL_BSH_PAIRS_ANY_SEARCH_INL_H_
#endif

#include <pcl_bsh/query/length_band.h>
#include <pcl_bsh/traversal/beyond_reach.h>
#include <pcl_bsh/traversal/shared_stack.h>
#include <pcl_bsh/traversal/visit_pairs-inl.h>

#include <algorithm>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// An observer that does nothing: its calls compile to nothing.
struct NoObserver {
  static void seeded(const LanePair&) {}
  static void stepped(const LanePair&, Opened, const PairWalk::Step&) {}
  static void compared(const LanePair&) {}
  static bool stops(const PairWalk&, const LanePair&) { return false; }
};

inline AnyResult resultOf(const LengthBand& length_band, const std::optional<PointPair>& witness, bool stopped,
                          const Work& work)
{
  AnyResult result;
  result.pair = witness;
  result.work = work;
  result.verdict = witness ? Verdict::colliding : stopped ? Verdict::undecided : Verdict::free;
  if (result.verdict != Verdict::undecided)
    (witness ? result.interval.upper : result.interval.lower) =
        witness ? length_band.surely_within : length_band.surely_beyond;
  return result;
}

/// @tparam Observer is called with the pairs of the roots' children that may meet (seeded), with each pair whose larger
///   side was opened and the test of its children (stepped), with each pair of leaves whose points were compared
///   (compared), and before each pair is looked at, whether to stop there (stops)
template <class Observer>
class AnySearch : public PairVisitor {
public:
  AnySearch(const Placed& a, const Placed& b, const AnyRequest& request, Observer observer,
            MeantPlaces places = MeantPlaces::measured, const Watch& by = {})
  : PairVisitor(by),
    walk_(a, b),
    pairs_(a, b, request.clearance, places),
    length_band_(pairs_.reach, request.accuracy),
    observer_(std::move(observer))
  {
  }

  AnyResult run()
  {
    stack_.clear();
    walk_.seed(reach(), [this](const LanePair& pair, const PairWalk::Step&, std::uint32_t) {
      observer_.seeded(pair);
      stack_.push_back(pair);
    });
    nearestLast(stack_, 0);
    const std::optional<PointPair> witness = search();
    return resultOf(length_band_, witness, stopped_, walk_.work);
  }

  /// Visits the pairs of a piece and what is below, until a witness is found or the observer stops, which is allowed
  /// some steps.
  void operator()(SharedStack<LanePair>::Piece& piece)
  {
    observer_.allow({kStepsOfPiece, &piece.dropped});
    stack_.assign(piece.pairs.begin(), piece.pairs.end());
    piece.found = search();
    piece.pairs.assign(stack_.begin(), stack_.end());
    piece.work = std::exchange(walk_.work, Work());
  }

  const Work& work() const { return walk_.work; }

  /// The pairs that are left to be visited since the observer stopped the search, the next one last.
  const std::vector<LanePair>& left() const { return stack_; }

  // As visitPairs() asks.

  double reach() const { return length_band_.miss; }

  Next visit(const LanePair& pair)
  {
    stopped_ = observer_.stops(walk_, pair);
    if (stopped_) return Next::stop;
    return HWY_UNLIKELY(beyond_.mayKnow()) && isBeyond(pair) ? Next::prune : Next::go_on;
  }

  Next opened(const LanePair& pair, Opened opened, const PairWalk::Step& step)
  {
    observer_.stepped(pair, opened, step);
    const std::uint32_t inside = step.inside(length_band_.hit);
    if (inside == 0) return Next::go_on;
    const LanePair child = PairWalk::childOf(pair, opened, step, static_cast<std::uint32_t>(std::countr_zero(inside)));
    witness_ = PointPair{firstRecord(walk_.a, child.a), firstRecord(walk_.b, child.b)};
    return Next::stop;
  }

  Next compare(const LanePair& pair)
  {
    observer_.compared(pair);
    const ComparedLeaves leaves = walk_.compare(pair, reach());
    if (leaves.near == 0) return Next::go_on;
    const auto found = [&](std::uint32_t i, std::uint32_t j, bool surely) {
      const PointPair candidate{leaves.a.record(i), leaves.b.record(j)};
      if (surely || pairs_.collide(candidate, walk_.work))
        witness_ = candidate;
      else
        beyond_.found(candidate);
      return witness_.has_value();
    };
    if (walk_.haveTriangles()) {
      eachPairNearTriangles(
          leaves, walk_.a.storage.view, walk_.b.storage.view, walk_.flat(), [this] { return std::max(reach(), 0.0); },
          [&](std::uint32_t i, std::uint32_t j) { return found(i, j, false); });
    }
    else if (pairs_.haveRadii()) {
      eachBallPairNear(leaves.frame, leaves.points, leaves.near, leaves.a, leaves.b, reach(), pairs_.surelyOfBalls(),
                       [&](std::uint32_t i, std::uint32_t j, float, bool surely) { return found(i, j, surely); });
    }
    else {
      const DistanceBand band = length_band_.band(leaves.frame);
      alignas(64) float nearest[kLeafPoints];
      std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
      nearestSquared(leaves.points, leaves.b.x(), leaves.b.y(), leaves.b.z(), firstBits(leaves.b.count), nearest);
      eachPairNotBeyond(
          leaves.points, leaves.near & ~above(nearest, band.miss), leaves.b, band.miss,
          [&](std::uint32_t i, std::uint32_t j, float squared) { return found(i, j, squared <= band.hit); });
    }
    return witness_ ? Next::stop : Next::go_on;
  }

private:
  std::optional<PointPair> search()
  {
    witness_.reset();
    visitPairs(walk_, stack_, *this);
    return witness_;
  }

  HWY_NOINLINE bool isBeyond(const LanePair& pair)
  {
    return beyond_.knows(walk_.child(walk_.a, pair.a), walk_.child(walk_.b, pair.b));
  }

  std::uint32_t firstRecord(const Spaces& side, const Lane& lane)
  {
    const std::uint32_t begin = walk_.nodeOf(side, lane).begin[lane.lane];
    if (lane.space != kAboveVoxels) return side.storage.voxels[lane.space].records()[begin];
    return side.voxel(begin, walk_.work).records()[0];
  }

  PairWalk walk_;
  const PointPairs pairs_;
  const LengthBand length_band_;
  BeyondReach beyond_{pairs_, walk_.a.storage, walk_.b.storage};
  Observer observer_;
  std::optional<PointPair> witness_;
  bool stopped_ = false;
  const ScratchLease<PairStack> kept_stack_;
  std::vector<LanePair>& stack_ = (*kept_stack_).pairs;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
