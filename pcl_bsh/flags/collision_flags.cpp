// SPDX-License-Identifier: BSD-3-Clause
// Flags as an array: one for each record.
#include <pcl_bsh/flags/check_request.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/flags/query.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/traversal/voxel_passes.h>

#include <atomic>
#include <vector>

namespace pcl_bsh {
namespace {

/// The flags of one cloud: whose points are flagged, in which voxels, and in how many passes.
class FlagSide {
public:
  FlagSide(const Placed& a, const Placed& b, const FlagsRequest& request, MeantPlaces places, const StopRule& rule,
           std::vector<Verdict>& flags, Work& work, Progress& progress, const PatchSpacings& patches_of_b = {})
  : flags_(flags),
    marked_(rule.mayStop() && rule.deepest == StopRule::kNever),
    pairs_(a, b, request.clearance, places == MeantPlaces::either ? MeantPlaces::possible : places, patches_of_b),
    certain_(a, b, request.clearance, MeantPlaces::certain),
    query_{a,
           b,
           pairs_,
           RelativeRotation(a.pose, b.pose),
           LengthBand(pairs_.reach, request.accuracy),
           places == MeantPlaces::either ? &certain_ : nullptr,
           LengthBand(places == MeantPlaces::either ? certain_.reach : pairs_.reach, request.accuracy)},
    voxels_(threadCount(request.threads), work, progress)
  {
    if (!a.hierarchy().empty() && !b.hierarchy().empty()) {
      if (marked_)
        for (std::uint32_t v = 0; v < a.hierarchy().storage().voxel_count; ++v) voxels_.places.push_back(v);
      else
        findNearVoxels(query_, voxels_.places, work);
    }
    const SphereHierarchy& cloud = a.hierarchy();
    const bool whole = cloud.size() == cloud.view().count; // the hierarchy holds all records
    flags_.assign(cloud.view().count, marked_ && whole && !voxels_.places.empty() ? Verdict::undecided : Verdict::free);
    if (!marked_ || whole) return;
    for (const std::uint32_t voxel : voxels_.places)
      cloud.storage().forEachRecord(voxel, [this](std::uint32_t record) { flags_[record] = Verdict::undecided; });
  }

  /// As VoxelPasses has them.
  std::size_t steps(const StopRule& rule) const { return voxels_.steps(rule); }
  std::uint64_t spent() const { return voxels_.spent(); }
  void passes(const StopRule& rule, std::uint64_t tests)
  {
    voxels_.run(rule, tests, [this](const StopRule& own, std::uint32_t voxel) {
      FlagWriter writer(query_.a.hierarchy().storage(), voxel, flags_.data(), marked_);
      const FlaggedVoxel found = flagVoxel(query_, own, voxel, writer);
      colliding_.fetch_add(writer.colliding, std::memory_order_relaxed);
      return found;
    });
  }

  std::size_t colliding() const { return colliding_.load(std::memory_order_relaxed); }

private:
  std::vector<Verdict>& flags_;
  /// Whether points are undecided at first: a budget may end before a voxel is looked at. A walk to a level looks at
  /// every voxel that comes near; points of the others are free.
  const bool marked_;
  const PointPairs pairs_;
  const PointPairs certain_;
  const FlagQuery query_;
  VoxelPasses<std::uint32_t, FlaggedVoxel> voxels_; ///< with undecided points
  std::atomic<std::size_t> colliding_{0};
};

/// Flags points that are where `places` says. Takes the progress from the share `from` of the whole to the share `to`.
void flagPlaces(const Placed& a, const Placed& b, const FlagsRequest& request, MeantPlaces places, FlagsResult& found,
                Progress& progress, double from, double to)
{
  const StopRule rule(request.accuracy);
  const bool both = request.flagged == Flagged::both;
  if (both && rule.mayStop()) {
    FlagSide side_a(a, b, request, places, rule, found.a, found.work, progress),
        side_b(b, a, request, places, rule, found.b, found.work, progress);
    progress.begin(to, 2 * side_a.steps(rule) + side_b.steps(rule)); // a may come to its turn again
    passBothWithin(side_a, side_b, rule);
    found.colliding_a = side_a.colliding();
    found.colliding_b = side_b.colliding();
  }
  else {
    const auto collidingOf = [&](const Placed& of, const Placed& other, std::vector<Verdict>& flags, double end,
                                 const PatchSpacings& patches_of_other) {
      FlagSide side(of, other, request, places, rule, flags, found.work, progress, patches_of_other);
      progress.begin(end, side.steps(rule));
      side.passes(rule, rule.node_pairs);
      return side.colliding();
    };
    const PatchSpacings patches(places == MeantPlaces::covered ? request.spacings_of_b : nullptr,
                                b.hierarchy().view().count);
    if (request.flagged != Flagged::b)
      found.colliding_a = collidingOf(a, b, found.a, both ? 0.5 * (from + to) : to, patches);
    if (request.flagged != Flagged::a) found.colliding_b = collidingOf(b, a, found.b, to, {});
  }
  if (!request.accuracy.stopsEarly() && places != MeantPlaces::either) return;
  found.undecided_a = countOf(found.a, Verdict::undecided);
  found.undecided_b = countOf(found.b, Verdict::undecided);
}

/// Share of the progress that the flags themselves make, where a density guard looks at them again.
constexpr double kUnguarded = 0.5;

/// Free points that may be within the clearance of a patch of b's surface are sparse.
void guardDensity(const Placed& a, const Placed& b, FlagsRequest request, FlagsResult& found, Progress& progress)
{
  request.flagged = Flagged::a;
  FlagsResult covered;
  flagPlaces(a, b, request, MeantPlaces::covered, covered, progress, kUnguarded, 1.0);
  for (std::size_t i = 0; i < found.a.size(); ++i) {
    if (found.a[i] != Verdict::free || covered.a[i] == Verdict::free) continue;
    const bool sparse = covered.a[i] == Verdict::colliding;
    found.a[i] = sparse ? Verdict::sparse : Verdict::undecided;
    ++(sparse ? found.sparse_a : found.undecided_a);
  }
  found.work += covered.work;
}

} // namespace

void collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request, FlagsResult& result)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  FlagsResult found;
  found.a.swap(result.a);
  found.b.swap(result.b);
  result = FlagsResult(); // should something throw, it has neither colliding nor free points
  found.a.clear();
  found.b.clear();
  Progress progress(request.progress);
  const bool guarded = request.spacings_of_b && request.flagged != Flagged::b;
  flagPlaces(a, b, request, areUncertain(a, b) ? MeantPlaces::either : MeantPlaces::measured, found, progress, 0.0,
             guarded ? kUnguarded : 1.0);
  if (guarded) guardDensity(a, b, request, found, progress);
  progress.finish();
  result = std::move(found);
}

FlagsResult collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request)
{
  FlagsResult result;
  collisionFlags(a, b, request, result);
  return result;
}

} // namespace pcl_bsh
