// SPDX-License-Identifier: BSD-3-Clause
// Flags as lists of what collides and what is left undecided.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/flags/check_request.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/flags/side.h>
#include <pcl_bsh/query/uncertain.h>

#include <hwy/contrib/sort/vqsort.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/flags/colliding_indices.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/flags/walk-inl.h>

#ifndef PCL_BSH_COLLISION_COLLIDING_INDICES_ONCE
#define PCL_BSH_COLLISION_COLLIDING_INDICES_ONCE
namespace pcl_bsh {
namespace {

using Indices = std::vector<std::int32_t>;

/// What the walks through one voxel have found.
struct VoxelLists {
  Indices colliding; ///< in any order, some more than once
  Indices undecided; ///< after the passes so far
  Indices possible;  ///< of uncertain points: those that may collide, in any order, perhaps among the others, too
  Indices left;      ///< undecided by the last walk
  bool none_decided = true; ///< nothing of the voxel was looked at so far
  bool left_all = false;    ///< nor by the last walk

  void begin()
  {
    colliding.clear();
    undecided.clear();
    possible.clear();
    none_decided = true;
  }

  void collide(std::uint32_t record) { colliding.push_back(static_cast<std::int32_t>(record)); }
  static bool takesFree() { return false; }
  static void free(std::uint32_t) {}
  static bool takesUndecided() { return true; }
  void leave(std::uint32_t record) { left.push_back(static_cast<std::int32_t>(record)); }
  void leaveAll() { left_all = true; }

  void beginWalk()
  {
    left.clear();
    left_all = false;
  }

  void perhaps(std::uint32_t record) { possible.push_back(static_cast<std::int32_t>(record)); }

  /// What any walk decides stays decided.
  void endWalk()
  {
    if (left_all) return;
    std::sort(left.begin(), left.end());
    if (!none_decided) {
      const auto end = std::set_intersection(undecided.begin(), undecided.end(), left.begin(), left.end(),
                                             undecided.begin()); // never ahead of what it reads
      undecided.erase(end, undecided.end());
    }
    else {
      undecided.swap(left);
    }
    none_decided = false;
  }
};

} // namespace
} // namespace pcl_bsh
#endif

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

FlaggedVoxel listVoxelOnTarget(const FlagQuery& query, const StopRule& rule, std::uint32_t voxel, VoxelLists& lists)
{
  return walkVoxel(query, rule, voxel, lists);
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {

HWY_EXPORT(listVoxelOnTarget);

/// Memory of one cloud's lists after another, to be had by a ScratchLease.
struct ListScratch {
  std::vector<VoxelLists> voxels;     ///< by slot; more than the last query had, for their storage
  std::vector<std::uint32_t> numbers; ///< of the voxels, by slot
  hwy::Sorter sorter;

  std::size_t bytes() const noexcept
  {
    std::size_t sum = voxels.capacity() * sizeof(VoxelLists) + numbers.capacity() * sizeof(std::uint32_t);
    for (const VoxelLists& lists : voxels)
      sum += (lists.colliding.capacity() + lists.undecided.capacity() + lists.possible.capacity() +
              lists.left.capacity()) *
             sizeof(std::int32_t);
    return sum;
  }
};

/// The lists of one cloud.
class ListSheet {
public:
  ListSheet(Indices& colliding, Indices& undecided) : colliding_(colliding), undecided_(undecided) {}

  void begin(const FlagQuery& query, const std::vector<FlaggedPlace>& places, bool)
  {
    cloud_ = &query.a.hierarchy().storage();
    are_uncertain_ = query.certain != nullptr;
    ListScratch& scratch = *lease_.emplace();
    if (scratch.voxels.size() < places.size()) scratch.voxels.resize(places.size());
    scratch.numbers.clear();
    for (const FlaggedPlace& place : places) {
      scratch.voxels[place.slot].begin();
      scratch.numbers.push_back(place.voxel);
    }
  }

  FlaggedVoxel walk(const FlagQuery& query, const StopRule& rule, const FlaggedPlace& place)
  {
    VoxelLists& lists = (**lease_).voxels[place.slot];
    lists.beginWalk();
    const FlaggedVoxel found = HWY_DYNAMIC_DISPATCH(listVoxelOnTarget)(query, rule, place.voxel, lists);
    lists.endWalk();
    return found;
  }

  void end()
  {
    ListScratch& scratch = **lease_;
    for (std::size_t slot = 0; slot < scratch.numbers.size(); ++slot) {
      const VoxelLists& lists = scratch.voxels[slot];
      colliding_.insert(colliding_.end(), lists.colliding.begin(), lists.colliding.end());
      for (const Indices* const left : {&lists.undecided, &lists.possible})
        undecided_.insert(undecided_.end(), left->begin(), left->end());
      if (!lists.none_decided) continue;
      cloud_->forEachRecord(scratch.numbers[slot],
                            [this](std::uint32_t record) { undecided_.push_back(static_cast<std::int32_t>(record)); });
    }
    for (Indices* const indices : {&colliding_, &undecided_}) {
      scratch.sorter(indices->data(), indices->size(), hwy::SortAscending());
      indices->erase(std::unique(indices->begin(), indices->end()), indices->end());
    }
    if (are_uncertain_) // some of those that may collide were found to do so later
      undecided_.erase(std::set_difference(undecided_.begin(), undecided_.end(), colliding_.begin(), colliding_.end(),
                                           undecided_.begin()), // never ahead of what it reads
                       undecided_.end());
    lease_.reset();
  }

private:
  Indices& colliding_;
  Indices& undecided_;
  std::optional<ScratchLease<ListScratch>> lease_;
  const SphereHierarchy::Storage* cloud_ = nullptr;
  bool are_uncertain_ = false;
};

} // namespace

void collidingIndices(const Placed& a, const Placed& b, const FlagsRequest& request, CollidingIndices& result)
{
  check(a, b, request);
  if (request.spacings_of_b)
    throw InvalidInput(Input::density, "density guard", "lists of points do not know it", "ask collisionFlags()");
  const DefaultFloatEnvironment environment;
  CollidingIndices found;
  std::swap(found, result); // should something throw, the result has no collision
  for (Indices* const indices : {&found.a, &found.b, &found.undecided_a, &found.undecided_b}) indices->clear();
  ListSheet sheet_a(found.a, found.undecided_a), sheet_b(found.b, found.undecided_b);
  found.work = flagSides(a, b, request, areUncertain(a, b) ? Places::either : Places::measured, sheet_a, sheet_b);
  result = std::move(found);
}

CollidingIndices collidingIndices(const Placed& a, const Placed& b, const FlagsRequest& request)
{
  CollidingIndices result;
  collidingIndices(a, b, request, result);
  return result;
}

} // namespace pcl_bsh
#endif
