// SPDX-License-Identifier: BSD-3-Clause
// Whose points are flagged, in which voxels, and in how many passes: all of flags but the walk and where they go.
#pragma once

#include <pcl_bsh/collision/collision_flags.h>
#include <pcl_bsh/collision/flag_query.h>
#include <pcl_bsh/hierarchy/kept_scratch.h>
#include <pcl_bsh/hierarchy/parallel.h>

#include <algorithm>
#include <vector>

namespace pcl_bsh {

/// Memory of one side after another, to be had by a ScratchLease.
struct FlagSideScratch {
  std::vector<FlaggedPlace> places;
  std::vector<FlaggedVoxel> parts;

  std::size_t bytes() const noexcept
  {
    return places.capacity() * sizeof(FlaggedPlace) + parts.capacity() * sizeof(FlaggedVoxel);
  }
};

/// The flags of one cloud.
/// @tparam Sheet where they go. `begin(query, places, marked)`: before the first walk, with the voxels to be walked;
/// all
///   of the cloud's, with undecided points, where `marked`, else those that come near to the other cloud. `FlaggedVoxel
///   walk(query, rule, place)`: from several threads at once, for different voxels; of a voxel again where points were
///   left undecided. `end()`: after the last walk.
template <class Sheet>
class FlagSide {
public:
  FlagSide(const Placed& a, const Placed& b, const FlagsRequest& request, Places places, const StopRule& rule,
           Sheet& sheet, Work& work)
  : sheet_(sheet),
    work_(work),
    pairs_(a, b, request.clearance, places),
    query_{a, b, pairs_, RelativeRotation(a.pose, b.pose), Acceptance(pairs_.reach, request.accuracy)},
    threads_(threadCount(request.threads)),
    places_((*scratch_).places),
    parts_((*scratch_).parts)
  {
    places_.clear();
    // A budget may end before a voxel is looked at. A level looks at all, and has to mark only those that come near.
    const bool marked = rule.mayStop() && rule.deepest == StopRule::kNever;
    if (!a.hierarchy().empty() && !b.hierarchy().empty()) {
      if (marked)
        for (std::uint32_t v = 0; v < a.hierarchy().storage().voxel_count; ++v) places_.push_back({v, v});
      else
        findNearVoxels(query_, places_, work_);
    }
    sheet_.begin(query_, places_, marked);
  }

  /// Whether every point is decided.
  bool done() const { return places_.empty(); }

  /// Sphere tests of all passes so far.
  std::uint64_t spent() const { return spent_; }

  /// All passes of a rule. @param tests for all of them, those already spent among them
  void passes(StopRule rule, std::uint64_t tests)
  {
    if (!rule.mayStop()) return pass(rule);
    for (const std::uint64_t deepest : rule.passes()) {
      rule.deepest = deepest;
      if (tests != StopRule::kNever) rule.node_pairs = tests - std::min(tests, spent_);
      pass(rule);
    }
  }

private:
  /// Walks what was left undecided. The rule's sphere tests are for this pass.
  void pass(const StopRule& rule)
  {
    parts_.assign(places_.size(), FlaggedVoxel());
    const auto walk = [&](std::size_t i, const StopRule& own) { parts_[i] = sheet_.walk(query_, own, places_[i]); };
    if (rule.node_pairs == StopRule::kNever) {
      parallelFor(places_.size(), threads_, [&](std::size_t i) { walk(i, rule); });
    }
    else { // one after another: what one leaves is the next one's
      StopRule own = rule;
      for (std::size_t i = 0; i < places_.size(); ++i) {
        walk(i, own);
        own.node_pairs -= std::min(own.node_pairs, parts_[i].work.node_pairs);
      }
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      work_ += parts_[i].work;
      spent_ += parts_[i].work.node_pairs;
      if (parts_[i].undecided && rule.mayStop()) places_[left++] = places_[i];
    }
    places_.resize(left);
  }

  const ScratchLease<FlagSideScratch> scratch_;
  Sheet& sheet_;
  Work& work_;
  const PointPairs pairs_;
  const FlagQuery query_;
  const unsigned threads_;
  std::vector<FlaggedPlace>& places_; ///< with undecided points
  std::vector<FlaggedVoxel>& parts_;  ///< of the last pass
  std::uint64_t spent_ = 0;
};

/// Both clouds share the budget: each has half of it, and what one leaves is the other's.
template <class Sheet>
void flagBothWithin(FlagSide<Sheet>& a, FlagSide<Sheet>& b, const StopRule& rule)
{
  const StopRule half = rule.part(0.5);
  a.passes(half, half.node_pairs);
  // Of a count of tests, b gets more than half only when a is done: then a is done with any larger count as well, and
  // whatever a count decides, a larger one decides.
  const std::uint64_t left = rule.node_pairs - std::min(rule.node_pairs, a.spent());
  b.passes(rule, rule.node_pairs == StopRule::kNever || !a.done() ? half.node_pairs : std::max(half.node_pairs, left));
  if (rule.isTimed()) a.passes(rule, StopRule::kNever);
}

/// Flags the points that the request asks for. @return the work
template <class Sheet>
Work flagSides(const Placed& a, const Placed& b, const FlagsRequest& request, Places places, Sheet& sheet_a,
               Sheet& sheet_b)
{
  Work work;
  const StopRule rule(request.accuracy);
  if (request.flagged == Side::both && rule.mayStop()) {
    FlagSide side_a(a, b, request, places, rule, sheet_a, work), side_b(b, a, request, places, rule, sheet_b, work);
    flagBothWithin(side_a, side_b, rule);
    sheet_a.end();
    sheet_b.end();
    return work;
  }
  if (request.flagged != Side::b) {
    FlagSide(a, b, request, places, rule, sheet_a, work).passes(rule, rule.node_pairs);
    sheet_a.end();
  }
  if (request.flagged != Side::a) {
    FlagSide(b, a, request, places, rule, sheet_b, work).passes(rule, rule.node_pairs);
    sheet_b.end();
  }
  return work;
}

} // namespace pcl_bsh
