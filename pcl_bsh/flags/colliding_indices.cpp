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

namespace pcl_bsh {
namespace {

using Indices = std::vector<std::int32_t>;

/// What the walks through one voxel have found.
struct VoxelLists final : FlagSink {
  Indices colliding; ///< in any order, some more than once
  Indices undecided; ///< after the passes so far
  Indices possible;  ///< of uncertain points: those that may collide, in any order, perhaps among the others, too
  Indices left;      ///< undecided by the last walk
  bool none_decided = true; ///< nothing of the voxel was looked at so far
  bool left_all = false;    ///< nor by the last walk
  const SphereHierarchy::Storage* cloud = nullptr;
  std::uint32_t voxel = 0;

  void begin(const SphereHierarchy::Storage& of, std::uint32_t number)
  {
    cloud = &of;
    voxel = number;
    colliding.clear();
    undecided.clear();
    possible.clear();
    none_decided = true;
  }

  void tell(Finding finding, const std::uint32_t* first, const std::uint32_t* last) override
  {
    if (finding == Finding::free) return;
    Indices& list = finding == Finding::colliding ? colliding : finding == Finding::possible ? possible : left;
    list.insert(list.end(), first, last);
  }

  void tellAll(Finding finding) override
  {
    left_all = left_all || finding == Finding::left;
    if (finding == Finding::colliding) appendAll(colliding);
  }

  void appendAll(Indices& list) const
  {
    cloud->forEachRecord(voxel, [&](std::uint32_t record) { list.push_back(static_cast<std::int32_t>(record)); });
  }

  void beginWalk()
  {
    left.clear();
    left_all = false;
  }

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

/// Memory of one cloud's lists after another, to be had by a ScratchLease.
struct ListScratch {
  std::vector<VoxelLists> voxels; ///< by slot; more than the last query had, for their storage
  std::size_t count = 0;          ///< those of the last query
  hwy::Sorter sorter;

  std::size_t bytes() const noexcept
  {
    std::size_t sum = voxels.capacity() * sizeof(VoxelLists);
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
    are_uncertain_ = query.certain != nullptr;
    ListScratch& scratch = *lease_.emplace();
    if (scratch.voxels.size() < places.size()) scratch.voxels.resize(places.size());
    scratch.count = places.size();
    for (const FlaggedPlace& place : places)
      scratch.voxels[place.slot].begin(query.a.hierarchy().storage(), place.voxel);
  }

  FlaggedVoxel walk(const FlagQuery& query, const StopRule& rule, const FlaggedPlace& place)
  {
    VoxelLists& lists = (**lease_).voxels[place.slot];
    lists.beginWalk();
    const FlaggedVoxel found = flagVoxel(query, rule, place.voxel, lists);
    lists.endWalk();
    return found;
  }

  void end()
  {
    ListScratch& scratch = **lease_;
    for (std::size_t slot = 0; slot < scratch.count; ++slot) {
      const VoxelLists& lists = scratch.voxels[slot];
      colliding_.insert(colliding_.end(), lists.colliding.begin(), lists.colliding.end());
      for (const Indices* const left : {&lists.undecided, &lists.possible})
        undecided_.insert(undecided_.end(), left->begin(), left->end());
      if (lists.none_decided) lists.appendAll(undecided_);
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
  Progress progress(request.progress);
  found.work = flagSides(a, b, request, areUncertain(a, b) ? Places::either : Places::measured, sheet_a, sheet_b,
                         progress, 0.0, 1.0);
  progress.finish();
  result = std::move(found);
}

CollidingIndices collidingIndices(const Placed& a, const Placed& b, const FlagsRequest& request)
{
  CollidingIndices result;
  collidingIndices(a, b, request, result);
  return result;
}

} // namespace pcl_bsh
