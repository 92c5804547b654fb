// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/pairs/any_at_places.h>
#include <pcl_bsh/pairs/check_request.h>
#include <pcl_bsh/pairs/trace.h>

#include <map>
#include <tuple>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/trace.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/any_search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

/// The spheres of one cloud that a walk has met.
class Met {
public:
  explicit Met(const Placed& placed) : side_(placed)
  {
    if (side_.storage.size == 0) return;
    for (std::uint32_t i = 0; i < side_.storage.top[0].count; ++i) note({kAboveVoxels, 0, i}, SphereFate::pruned, -1);
  }

  void note(const Lane& lane, SphereFate fate, int level)
  {
    const auto [at, added] = met_.try_emplace({lane.space, lane.node, lane.lane}, Entry{fate, level});
    if (!added) at->second.fate = std::max(at->second.fate, fate);
  }

  void noteChildren(const Lane& entered, std::uint32_t near, int level)
  {
    for (std::uint32_t i = 0; i < side_.node(entered.space, entered.node).count; ++i)
      note({entered.space, entered.node, i}, (near >> i & 1u) != 0 ? SphereFate::kept : SphereFate::pruned, level);
  }

  /// The level of a lane that was met before, or of a child of the tree above the voxels.
  int levelOf(const Lane& lane) const { return met_.at({lane.space, lane.node, lane.lane}).level; }

  /// The level of the children in the node below a lane.
  int levelBelow(const Lane& lane, const Lane& entered) const
  {
    return entered.space == kAboveVoxels ? -1 : std::max(levelOf(lane), 0) + 1;
  }

  std::vector<TracedSphere> spheres() const
  {
    std::vector<TracedSphere> all;
    all.reserve(met_.size());
    for (const auto& [key, entry] : met_) {
      const auto [space, index, lane] = key;
      const Node& node = side_.node(space, index);
      const LocalFrame& frame = side_.frame(space);
      const bool is_voxel = space == kAboveVoxels && node.isLeaf(lane);
      all.push_back({{frame.origin[0] + node.x[lane] * frame.unit, frame.origin[1] + node.y[lane] * frame.unit,
                      frame.origin[2] + node.z[lane] * frame.unit},
                     node.r[lane] * frame.unit,
                     is_voxel ? 0 : entry.level,
                     entry.fate});
    }
    return all;
  }

private:
  struct Entry {
    SphereFate fate;
    int level;
  };

  Spaces side_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, Entry> met_;
};

struct TraceObserver : NoObserver {
  TraceObserver(Met& met_a, Met& met_b) : a(&met_a), b(&met_b) {}

  Met* a;
  Met* b;

  void stepped(const LanePair& pair, Opened opened, const PairWalk::Step& step)
  {
    Met& side = opened == Opened::a ? *a : *b;
    const Lane& parent = opened == Opened::a ? pair.a : pair.b;
    const int level = side.levelBelow(parent, step.entered);
    side.note(parent, SphereFate::opened, -1);
    side.noteChildren(step.entered, step.near, level);
  }

  void seeded(const LanePair& pair)
  {
    a->note(pair.a, SphereFate::kept, -1);
    b->note(pair.b, SphereFate::kept, -1);
  }

  void compared(const LanePair& pair)
  {
    a->note(pair.a, SphereFate::compared, -1);
    b->note(pair.b, SphereFate::compared, -1);
  }
};

} // namespace

CollisionTrace traceOnTarget(const Placed& a, const Placed& b, const AnyRequest& request)
{
  Met met_a(a), met_b(b);
  CollisionTrace trace;
  Progress progress(request.progress);
  const auto search = [&](MeantPlaces places, const Watch& watch) {
    return AnySearch(a, b, request, TraceObserver(met_a, met_b), places, watch).run();
  };
  trace.result =
      areUncertain(a, b) ? anyOfUncertain(progress, search) : search(MeantPlaces::measured, {&progress, 1.0});
  progress.finish();
  trace.a = met_a.spheres();
  trace.b = met_b.spheres();
  // Nothing is left to visit: the spheres that a kept sphere met were opened, and their children are out of reach.
  if (trace.result.verdict == Verdict::free) {
    for (std::vector<TracedSphere>* const side : {&trace.a, &trace.b})
      for (TracedSphere& sphere : *side)
        if (sphere.fate == SphereFate::kept) sphere.fate = SphereFate::pruned;
  }
  return trace;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(traceOnTarget);

CollisionTrace traceCollision(const Placed& a, const Placed& b, const AnyRequest& request)
{
  check(a, b, request);
  if (request.accuracy.stopsEarly())
    throw InvalidInput(Input::accuracy, "accuracy", request.accuracy.text() + " stops early, which is not traced",
                       "give exact or tolerance");
  const DefaultFloatEnvironment environment;
  return HWY_DYNAMIC_DISPATCH(traceOnTarget)(a, b, request);
}

} // namespace pcl_bsh
#endif
