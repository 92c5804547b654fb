// SPDX-License-Identifier: BSD-3-Clause
// Any pair, by one thread or by several: done at the first witness.
#include <pcl_bsh/pairs/any_at_places.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/check_request.h>
#include <pcl_bsh/pairs/closest_goal.h>

#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/any_collision.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/any_search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

namespace {

/// Stops the search where the rule's time is over, or is too short for a voxel that would have to be built.
class Hurried : public NoObserver {
public:
  explicit Hurried(const StopRule& rule) : rule_(rule), check_(rule, kNoTests) {}

  bool stops(const PairWalk& walk, const LanePair& pair)
  {
    if (check_.isOver()) return true;
    const Opened opened = walk.choose(pair);
    if (opened == Opened::neither) return false;
    const Spaces& side = opened == Opened::a ? walk.a : walk.b;
    const Lane& lane = opened == Opened::a ? pair.a : pair.b;
    const Node& node = walk.nodeOf(side, lane);
    if (lane.space != kAboveVoxels || !node.isLeaf(lane.lane)) return false;
    const std::size_t points = side.storage.pointsToBuild(node.begin[lane.lane]);
    return points != 0 && !rule_.leavesTimeToBuild(points);
  }

private:
  static constexpr std::uint64_t kNoTests = 0; ///< only time counts

  const StopRule& rule_;
  StopCheck check_;
};

/// Stops where one of several threads is to pause.
class Pausing : public NoObserver {
public:
  void allow(const Pause& pause) { pause_ = pause; }
  bool stops(const PairWalk&, const LanePair&) { return pause_.stops(); }

private:
  Pause pause_;
};

/// Searches by several threads; a search that is soon over takes one.
AnyResult searchShared(const Placed& a, const Placed& b, const AnyRequest& request, MeantPlaces places,
                       unsigned threads, const Watch& watch)
{
  std::optional<SharedStack<LanePair>> shared;
  Work alone;
  {
    AnySearch search(a, b, request, Pausing(), places, watch);
    const AnyResult result = search.run();
    if (result.verdict != Verdict::undecided) return result;
    alone = result.work;
    shared.emplace(search.left());
  } // its memory is free for this thread's share now
  shared->visit(threads, [&] { return AnySearch(a, b, request, Pausing(), places); });
  return resultOf({reachBetween(a, b, request.clearance, places), request.accuracy}, shared->found(), false,
                  alone += shared->work());
}

} // namespace

AnyResult anyCollisionOnTarget(const Placed& a, const Placed& b, const AnyRequest& request, MeantPlaces places,
                               unsigned threads, const Watch& watch)
{
  return threads > 1 ? searchShared(a, b, request, places, threads, watch)
                     : AnySearch(a, b, request, NoObserver(), places, watch).run();
}

AnyResult anyCollisionInTimeOnTarget(const Placed& a, const Placed& b, const AnyRequest& request, const StopRule& rule,
                                     const Watch& watch)
{
  return AnySearch(a, b, request, Hurried(rule), MeantPlaces::measured, watch).run();
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(anyCollisionOnTarget);
HWY_EXPORT(anyCollisionInTimeOnTarget);

namespace {

/// Share of a time budget for the search for a witness. It decides earlier than the search for the distance, which has
/// the rest for the interval that an undecided answer carries.
constexpr double kWitnessShare = 15.0 / 16;

AnyResult searchAsFarAsAllowed(const Placed& a, const Placed& b, const AnyRequest& request, Progress& progress)
{
  ClosestGoal goal(request.accuracy);
  goal.clearance = request.clearance;
  Work work;
  if (goal.rule.isTimed()) {
    AnyResult decided = HWY_DYNAMIC_DISPATCH(anyCollisionInTimeOnTarget)(a, b, request, goal.rule.part(kWitnessShare),
                                                                         {&progress, kWitnessShare});
    if (decided.verdict != Verdict::undecided) return decided;
    work = decided.work;
  }
  AnyResult found = searchWithin(a, b, goal, {&progress, 1.0});
  if (found.verdict != Verdict::colliding) found.pair.reset();
  found.work += work;
  return found;
}

/// Searches among points that may be elsewhere than they were measured.
AnyResult searchUncertain(const Placed& a, const Placed& b, const AnyRequest& request, Progress& progress)
{
  if (request.accuracy.stopsEarly()) {
    AnyResult found = searchWithin(a, b, ClosestGoal(request.accuracy), {&progress, 1.0});
    const bool certain = found.interval.upper <= reachBetween(a, b, request.clearance, MeantPlaces::certain).least;
    const bool possible = !(found.interval.lower > reachBetween(a, b, request.clearance, MeantPlaces::possible).most);
    found.verdict = certain ? Verdict::colliding : possible ? Verdict::undecided : Verdict::free;
    if (!certain) found.pair.reset();
    return found;
  }
  return anyOfUncertain(
      progress, [&](MeantPlaces places, const Watch& watch) { return anyCollisionAt(a, b, request, places, watch); });
}

} // namespace

AnyResult anyCollisionAt(const Placed& a, const Placed& b, const AnyRequest& request, MeantPlaces places,
                         const Watch& watch)
{
  return HWY_DYNAMIC_DISPATCH(anyCollisionOnTarget)(a, b, request, places, threadCount(request.threads), watch);
}

AnyResult anyCollision(const Placed& a, const Placed& b, const AnyRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  Progress progress(request.progress);
  AnyResult found = areUncertain(a, b) ? searchUncertain(a, b, request, progress)
                    : request.accuracy.stopsEarly()
                        ? searchAsFarAsAllowed(a, b, request, progress)
                        : anyCollisionAt(a, b, request, MeantPlaces::measured, {&progress, 1.0});
  progress.finish();
  return found;
}

} // namespace pcl_bsh
#endif
