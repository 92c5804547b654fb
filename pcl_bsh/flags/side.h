// SPDX-License-Identifier: BSD-3-Clause
// Whose points are flagged, in which voxels, and in how many passes: all of flags but the walk and where they go.
#pragma once

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/flags/query.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/traversal/voxel_passes.h>

namespace pcl_bsh {

/// The flags of one cloud.
/// @tparam Sheet where they go. `begin(query, places, marked)`: before the first walk, with the voxels to be walked;
///   all of the cloud's, with undecided points, where `marked`, else those that come near to the other cloud.
///   `FlaggedVoxel walk(query, rule, place)`: from several threads at once, for different voxels; of a voxel again
///   where points were left undecided. `end()`: after the last walk.
template <class Sheet>
class FlagSide {
public:
  FlagSide(const Placed& a, const Placed& b, const FlagsRequest& request, Places places, const StopRule& rule,
           Sheet& sheet, Work& work, Progress& progress, const PatchSpacings& patches_of_b = {})
  : sheet_(sheet),
    pairs_(a, b, request.clearance, places == Places::either ? Places::possible : places, patches_of_b),
    certain_(a, b, request.clearance, Places::certain),
    query_{a,
           b,
           pairs_,
           RelativeRotation(a.pose, b.pose),
           Acceptance(pairs_.reach, request.accuracy),
           places == Places::either ? &certain_ : nullptr,
           Acceptance(places == Places::either ? certain_.reach : pairs_.reach, request.accuracy)},
    voxels_(threadCount(request.threads), work, progress)
  {
    // A budget may end before a voxel is looked at. A level looks at all, and has to mark only those that come near.
    const bool marked = rule.mayStop() && rule.deepest == StopRule::kNever;
    if (!a.hierarchy().empty() && !b.hierarchy().empty()) {
      if (marked)
        for (std::uint32_t v = 0; v < a.hierarchy().storage().voxel_count; ++v) voxels_.places.push_back({v, v});
      else
        findNearVoxels(query_, voxels_.places, work);
    }
    sheet_.begin(query_, voxels_.places, marked);
  }

  /// As VoxelPasses has them.
  std::size_t steps(const StopRule& rule) const { return voxels_.steps(rule); }
  std::uint64_t spent() const { return voxels_.spent(); }
  void passes(const StopRule& rule, std::uint64_t tests)
  {
    voxels_.run(rule, tests,
                [this](const StopRule& own, const FlaggedPlace& place) { return sheet_.walk(query_, own, place); });
  }

private:
  Sheet& sheet_;
  const PointPairs pairs_;
  const PointPairs certain_;
  const FlagQuery query_;
  VoxelPasses<FlaggedPlace, FlaggedVoxel> voxels_; ///< with undecided points
};

/// Flags the points that the request asks for, which takes the progress from one share of the whole to another.
/// @return the work. @throws Cancelled
template <class Sheet>
Work flagSides(const Placed& a, const Placed& b, const FlagsRequest& request, Places places, Sheet& sheet_a,
               Sheet& sheet_b, Progress& progress, double from, double to)
{
  Work work;
  const StopRule rule(request.accuracy);
  if (request.flagged == Side::both && rule.mayStop()) {
    FlagSide side_a(a, b, request, places, rule, sheet_a, work, progress),
        side_b(b, a, request, places, rule, sheet_b, work, progress);
    progress.begin(to, 2 * side_a.steps(rule) + side_b.steps(rule)); // a may come to its turn again
    passBothWithin(side_a, side_b, rule);
    sheet_a.end();
    sheet_b.end();
    return work;
  }
  if (request.flagged != Side::b) {
    const PatchSpacings patches(places == Places::covered ? request.spacings_of_b : nullptr,
                                b.hierarchy().view().count);
    FlagSide side(a, b, request, places, rule, sheet_a, work, progress, patches);
    progress.begin(request.flagged == Side::both ? 0.5 * (from + to) : to, side.steps(rule));
    side.passes(rule, rule.node_pairs);
    sheet_a.end();
  }
  if (request.flagged != Side::a) {
    FlagSide side(b, a, request, places, rule, sheet_b, work, progress);
    progress.begin(to, side.steps(rule));
    side.passes(rule, rule.node_pairs);
    sheet_b.end();
  }
  return work;
}

} // namespace pcl_bsh
