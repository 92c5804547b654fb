// SPDX-License-Identifier: BSD-3-Clause
// The walk of contacts: to every pair of points that may be within a reach, which may shrink on the way.

#if defined(PCL_BSH_PAIRS_REACH_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_PAIRS_REACH_WALK_INL_H_
#undef PCL_BSH_PAIRS_REACH_WALK_INL_H_
#else
#define PCL_BSH_PAIRS_REACH_WALK_INL_H_
#endif

#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/simd/way_lanes-inl.h>
#include <pcl_bsh/traversal/visit_pairs-inl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Tells what a receiver did with a pair.
enum class Added { kept, dropped, stop };

/// Keeps a pair, until there are too many.
inline Added keepPair(PointPair pair, std::size_t most, PairsWithin& result)
{
  result.complete = result.pairs.size() < most;
  if (!result.complete) return Added::stop;
  result.pairs.push_back(pair);
  return Added::kept;
}

/// Walks to every pair of points that may be within a reach and hands it to a receiver. The receiver has `pairs`, which
/// decides them; `double reach()`, how far apart pairs are still of interest: it may shrink, to less than 0 where
/// points have radii; `Added add(PointPair, bool surely, Work&)`, where `surely` tells that the pair is known to
/// collide; `bool passesOver(PairWalk, LanePair)`, whether nothing below two lanes is of interest, before they are
/// opened or compared. Where a's points have ways (`kHasWays`), `enter(PairWalk, LanePair)` comes first: from then on
/// the reach is that of these two lanes.
template <class Receiver>
class ReachWalk : public PairVisitor {
public:
  ReachWalk(const Placed& a, const Placed& b, Receiver& receiver, Progress& progress)
  : PairVisitor(Watch{&progress, 1.0}),
    walk_(a, b),
    receiver_(receiver)
  {
  }

  Work run()
  {
    stack_.clear();
    walk_.seed(reach(), [this](LanePair pair, const PairWalk::Step& step, std::uint32_t lane) {
      keep(pair, Opened::b, step, lane);
      stack_.push_back(pair);
    });
    nearestLast(stack_, 0);
    visitPairs(walk_, stack_, *this);
    return walk_.work;
  }

  // As visitPairs() asks.

  /// The reach of sphere tests, never below 0.
  double reach() const { return std::max(receiver_.reach(), 0.0); }

  Next visit(const LanePair& pair)
  {
    if constexpr (Receiver::kHasWays) receiver_.enter(walk_, pair);
    return pair.key > receiver_.reach() || receiver_.passesOver(walk_, pair) ? Next::prune : Next::go_on;
  }

  bool keep(LanePair& pair, Opened, const PairWalk::Step& step, std::uint32_t lane) const
  {
    pair.key = walk_.boundKey(pair, step, lane);
    return true;
  }

  Next compare(const LanePair& pair)
  {
    const ComparedLeaves leaves = walk_.compare(pair, reach());
    if (leaves.near == 0) return Next::go_on;
    const LeafRange &a = leaves.a, &b = leaves.b;
    // Points of one place share a leaf, and the first of them was compared for all.
    const std::uint32_t places_a = coincident(walk_.a, pair.a), places_b = coincident(walk_.b, pair.b);
    bool going = true;
    const auto found = [&](std::uint32_t i, std::uint32_t j, bool surely) {
      going = addAll({a.voxel, a.begin + i, places_a}, {b.voxel, b.begin + j, places_b}, surely);
      return !going;
    };
    if (walk_.haveTriangles()) {
      eachPairNearTriangles(
          leaves, walk_.a.storage.view, walk_.b.storage.view, walk_.flat(), [this] { return reach(); },
          [&](std::uint32_t i, std::uint32_t j) { return found(i, j, false); });
    }
    else if (receiver_.pairs.haveRadii()) {
      eachBallPairNear(leaves.frame, leaves.points, leaves.near, a, b, receiver_.reach(),
                       receiver_.pairs.surelyOfBalls(),
                       [&](std::uint32_t i, std::uint32_t j, float, bool surely) { return found(i, j, surely); });
    }
    else if constexpr (Receiver::kHasWays) {
      if (!receiver_.goesOn(walk_.work)) return Next::stop;
      const PointsWay way = receiver_.way(walk_.b, leaves.frame);
      const float miss = receiver_.miss(leaves.frame);
      for (std::uint32_t j = 0; j < b.count && going; ++j) {
        const std::uint32_t passing =
            leaves.near & pointsPassing(leaves.points, way, b.x()[j], b.y()[j], b.z()[j], miss);
        for (const std::uint32_t i : Bits(passing)) {
          if (!going) break;
          found(i, j, false);
        }
      }
    }
    else {
      const float hit = leaves.frame.band(receiver_.pairs.reach.length()).hit;
      double reach = receiver_.reach();
      float miss = leaves.frame.band(reach).miss;
      eachPairNotBeyond(leaves.points, leaves.near, b, miss, [&](std::uint32_t i, std::uint32_t j, float squared) {
        if (receiver_.reach() < reach) { // shrunk since the last pair that was near
          reach = receiver_.reach();
          miss = leaves.frame.band(reach).miss;
        }
        return !(squared > miss) && found(i, j, squared <= hit);
      });
    }
    return going ? Next::go_on : Next::stop;
  }

private:
  /// How many points stand where the leaf's compared ones do: more than one only where a single one is compared.
  std::uint32_t coincident(const Spaces& side, const Lane& lane) const
  {
    const Node& node = walk_.nodeOf(side, lane);
    return node.isCoincident(lane.lane) ? node.points(lane.lane) : 1;
  }

  /// All pairs of two ranges of points, each of one place and one radius; records ascend where a range has several.
  bool addAll(const LeafRange& a, const LeafRange& b, bool surely)
  {
    for (std::uint32_t i = 0; i < a.count; ++i)
      for (std::uint32_t j = 0; j < b.count; ++j) {
        pulse_.count(1);
        const Added added = receiver_.add({a.record(i), b.record(j)}, surely, walk_.work);
        if (added == Added::stop) return false;
        if (added != Added::kept) return true; // of pairs at one distance, those that follow are larger still
        surely = true;
      }
    return true;
  }

  PairWalk walk_;
  Receiver& receiver_;
  Pulse pulse_; ///< of pairs at one place
  const ScratchLease<PairStack> kept_stack_;
  std::vector<LanePair>& stack_ = (*kept_stack_).pairs;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
