// SPDX-License-Identifier: BSD-3-Clause
// Flags as an array: one for each record.
#include <pcl_bsh/flags/check_request.h>
#include <pcl_bsh/flags/side.h>
#include <pcl_bsh/query/uncertain.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace pcl_bsh {
namespace {

/// Writes verdicts into an array in which all points are free, or all undecided, at first.
class FlagArray final : public FlagSink {
public:
  FlagArray(const SphereHierarchy::Storage& cloud, std::uint32_t voxel, Verdict* flags, bool marked)
  : cloud_(cloud),
    voxel_(voxel),
    flags_(flags),
    marked_(marked)
  {
  }

  void tell(Finding finding, const std::uint32_t* first, const std::uint32_t* last) override
  {
    each(finding, [=](const auto& take) { std::for_each(first, last, take); });
  }

  void tellAll(Finding finding) override
  {
    each(finding, [this](const auto& take) { cloud_.forEachRecord(voxel_, take); });
  }

  std::size_t colliding = 0; ///< points flagged so that were not before

private:
  /// @param visit calls a function for each record
  template <class Visit>
  void each(Finding finding, const Visit& visit)
  {
    if (finding == Finding::colliding) {
      visit([this](std::uint32_t record) {
        colliding += flags_[record] != Verdict::colliding;
        flags_[record] = Verdict::colliding;
      });
    }
    else if (finding == Finding::possible) {
      visit([this](std::uint32_t record) {
        if (flags_[record] != Verdict::colliding) flags_[record] = Verdict::undecided;
      });
    }
    else if ((finding == Finding::free) == marked_) {
      const Verdict flag = marked_ ? Verdict::free : Verdict::undecided;
      visit([this, flag](std::uint32_t record) { flags_[record] = flag; });
    }
  }

  const SphereHierarchy::Storage& cloud_;
  const std::uint32_t voxel_;
  Verdict* const flags_;
  const bool marked_;
};

/// The array of one cloud.
class FlagSheet {
public:
  explicit FlagSheet(std::vector<Verdict>& flags) : flags_(flags) {}

  void begin(const FlagQuery& query, const std::vector<FlaggedPlace>& places, bool marked)
  {
    const SphereHierarchy& cloud = query.a.hierarchy();
    marked_ = marked;
    flags_.assign(cloud.view().count,
                  marked && cloud.size() == cloud.view().count && !places.empty() ? Verdict::undecided : Verdict::free);
    if (!marked || cloud.size() == cloud.view().count) return;
    for (const FlaggedPlace& place : places) // the hierarchy does not hold all records
      cloud.storage().forEachRecord(place.voxel, [this](std::uint32_t record) { flags_[record] = Verdict::undecided; });
  }

  FlaggedVoxel walk(const FlagQuery& query, const StopRule& rule, const FlaggedPlace& place)
  {
    FlagArray array(query.a.hierarchy().storage(), place.voxel, flags_.data(), marked_);
    const FlaggedVoxel found = flagVoxel(query, rule, place.voxel, array);
    colliding_.fetch_add(array.colliding, std::memory_order_relaxed);
    return found;
  }

  static void end() {}

  std::size_t colliding() const { return colliding_.load(std::memory_order_relaxed); }

  std::size_t undecided() const { return countOf(flags_, Verdict::undecided); }

private:
  std::vector<Verdict>& flags_;
  std::atomic<std::size_t> colliding_{0};
  bool marked_ = false;
};

/// The flags of points that are where `places` says, which takes the progress from one share of the whole to another.
void flagPlaces(const Placed& a, const Placed& b, const FlagsRequest& request, Places places, FlagsResult& found,
                Progress& progress, double from, double to)
{
  FlagSheet sheet_a(found.a), sheet_b(found.b);
  found.work += flagSides(a, b, request, places, sheet_a, sheet_b, progress, from, to);
  found.colliding_a = sheet_a.colliding();
  found.colliding_b = sheet_b.colliding();
  if (!request.accuracy.stopsEarly() && places != Places::either) return;
  found.undecided_a = sheet_a.undecided();
  found.undecided_b = sheet_b.undecided();
}

/// Of flags that a density guard looks at again, what the flags themselves are of the whole.
constexpr double kUnguarded = 0.5;

/// Free points that may be within the clearance of a patch of b's surface are sparse.
void guardDensity(const Placed& a, const Placed& b, FlagsRequest request, FlagsResult& found, Progress& progress)
{
  request.flagged = Side::a;
  FlagsResult covered;
  flagPlaces(a, b, request, Places::covered, covered, progress, kUnguarded, 1.0);
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
  const bool guarded = request.spacings_of_b && request.flagged != Side::b;
  flagPlaces(a, b, request, areUncertain(a, b) ? Places::either : Places::measured, found, progress, 0.0,
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
