// SPDX-License-Identifier: BSD-3-Clause
// Any pair: depth first, nearest children first, done at the first witness.
#include <pcl_bsh/query/acceptance.h>
#include <pcl_bsh/query/collide.h>
#include <pcl_bsh/query/interval_search.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/query/any_collision.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/query/leaf_pair-inl.h>
#include <pcl_bsh/query/pair_walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

class AnySearch {
public:
  AnySearch(const Placed& a, const Placed& b, const CollisionRequest& request)
  : walk_(a, b),
    pairs_(a, b, request.clearance),
    acceptance_(request)
  {
    walk_.accepted_beyond = acceptance_.accepted - acceptance_.clearance;
  }

  AnyResult run()
  {
    AnyResult result;
    result.witness = search();
    result.verdict = result.witness ? Verdict::colliding : Verdict::free;
    if (acceptance_.proven)
      (result.witness ? result.distance.upper : result.distance.lower) =
          result.witness ? acceptance_.accepted : acceptance_.clearance;
    result.work = walk_.work;
    return result;
  }

private:
  std::optional<PointPair> search()
  {
    walk_.seed(pairs_.clearance,
               [this](const LanePair& pair, const PairWalk::Step&, std::uint32_t) { stack_.push_back(pair); });
    nearestLast(stack_, 0);
    PairWalk::Step step;
    while (!stack_.empty()) {
      const LanePair pair = stack_.back();
      stack_.pop_back();
      const Opened opened = walk_.choose(pair);
      if (opened == Opened::neither) {
        if (const auto witness = compareLeaves(pair)) return witness;
        continue;
      }
      walk_.step(pair, opened, pairs_.clearance, step);
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
    const LeafRange a = walk_.leaf(walk_.a, pair.a), b = walk_.leaf(walk_.b, pair.b);
    const RelativeFrame& frame = walk_.frames.find(pair.a.space, pair.b.space);
    LeafPoints points;
    carryLeaf(frame, a, points);
    const std::uint32_t lanes =
        pointsNearLeaf(frame, points, a, walk_.nodeOf(walk_.b, pair.b), pair.b.lane, pairs_.clearance);
    if (lanes == 0) return std::nullopt;

    std::optional<PointPair> witness;
    const auto found = [&](std::uint32_t i, std::uint32_t j, float squared, float hit) {
      const PointPair candidate{a.record(i), b.record(j)};
      if (squared <= hit || pairs_.collide(candidate, walk_.work)) witness = candidate;
      return witness.has_value();
    };
    if (pairs_.haveRadii()) {
      eachBallPairNear(frame, points, lanes, a, b, pairs_.clearance,
                       [&](std::uint32_t i, std::uint32_t j, float squared) { return found(i, j, squared, -1.0f); });
    }
    else {
      const DistanceBand band = acceptance_.band(frame);
      alignas(64) float nearest[kLeafPoints];
      std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
      nearestSquared(points, b.x(), b.y(), b.z(), b.count, nearest);
      eachPairNotBeyond(
          points, lanes & ~above(nearest, band.miss), b, band.miss,
          [&](std::uint32_t i, std::uint32_t j, float squared) { return found(i, j, squared, band.hit); });
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
  std::vector<LanePair> stack_;
};

} // namespace

AnyResult anyCollisionOnTarget(const Placed& a, const Placed& b, const CollisionRequest& request)
{
  return AnySearch(a, b, request).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(anyCollisionOnTarget);

AnyResult anyCollision(const Placed& a, const Placed& b, const CollisionRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  if (request.accuracy.stopsEarly()) {
    const IntervalFinding found = searchInterval(a, b, request.accuracy, request.clearance);
    const bool colliding = found.verdict == Verdict::colliding;
    return {found.verdict, colliding ? found.pair : std::nullopt, found.distance, found.work};
  }
  return HWY_DYNAMIC_DISPATCH(anyCollisionOnTarget)(a, b, request);
}

} // namespace pcl_bsh
#endif
