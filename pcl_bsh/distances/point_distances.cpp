// SPDX-License-Identifier: BSD-3-Clause
// Distances of all points: each voxel of a is one task and owns its points.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/distances/check_distances.h>
#include <pcl_bsh/distances/distance_query.h>
#include <pcl_bsh/distances/greatest_distance.h>
#include <pcl_bsh/distances/surface_hausdorff.h>
#include <pcl_bsh/query/request_check.h>
#include <pcl_bsh/traversal/voxel_passes.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/distances/point_distances.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/distances/distance_walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

MeasuredVoxel measureVoxelOnTarget(const DistancesQuery& query, const StopRule& rule, std::uint32_t voxel,
                                   const DistanceSheet& sheet)
{
  const ScratchLease<DistanceScratch> scratch;
  DistanceWalk walk(query, rule, sheet, *scratch);
  walk.run(voxel);
  return walk.found;
}

double farthestOfVoxelOnTarget(const DistancesQuery& query, const StopRule& rule, std::uint32_t voxel,
                               const DistanceSheet& sheet)
{
  const ScratchLease<DistanceScratch> scratch;
  return DistanceWalk(query, rule, sheet, *scratch).farthest(voxel);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {

HWY_EXPORT(measureVoxelOnTarget);
HWY_EXPORT(farthestOfVoxelOnTarget);

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

/// Begins with nothing measured, in the memory of an earlier result.
void clear(PointDistances& result, const Placed& a, const PointDistancesRequest& request)
{
  PointDistances fresh;
  fresh.distance.swap(result.distance);
  fresh.closest_point.swap(result.closest_point);
  fresh.interval.swap(result.interval);
  const SphereHierarchy& cloud = a.hierarchy();
  fresh.distance.assign(cloud.view().count, kNoDistance);
  fresh.closest_point.assign(cloud.view().count, kNothing);
  fresh.interval.clear();
  if (!request.accuracy.isExact()) {
    fresh.interval.assign(cloud.view().count, {kNoDistance, kNoDistance});
    for (std::size_t v = 0; v < cloud.storage().voxel_count; ++v)
      cloud.storage().forEachRecord(v, [&](std::uint32_t record) { fresh.interval[record] = Interval(); });
  }
  result = std::move(fresh);
}

/// Unit of the voxel with the middle point. In the unit of all voxels, an outlier at 1e20 leaves floats nothing to
/// tell.
double unitOfMost(const SphereHierarchy::Storage& storage)
{
  const Voxel* const first = storage.voxels.get();
  const auto begins_before = [&storage](const Voxel& voxel) { return voxel.begin <= storage.size / 2; };
  return std::prev(std::partition_point(first, first + storage.voxel_count, begins_before))->frame.unit;
}

/// One direction of a request.
class Direction {
public:
  Direction(const Placed& a, const Placed& b, const PointDistancesRequest& request, Progress& progress,
            PointDistances& result, ReachedDistance* reached = nullptr)
  : pairs_(a, b, request.max_distance),
    query_{a,
           b,
           pairs_,
           RelativeRotation(a.pose, b.pose),
           unitOfMost(b.hierarchy().storage()),
           request.accuracy.mode == Accuracy::Mode::tolerance ? request.accuracy.value : 0.0,
           reached},
    sheet_{result.distance.data(), result.closest_point.data(),
           result.interval.empty() ? nullptr : result.interval.data()},
    voxels_(threadCount(request.threads), result.work, progress)
  {
    voxels_.places.resize(a.hierarchy().storage().voxel_count);
    std::iota(voxels_.places.begin(), voxels_.places.end(), 0u);
  }

  /// Orders the walks: first through the voxels whose points may be the farthest.
  /// @return no point is farther from b than this
  double sortFarthestFirst(const StopRule& rule)
  {
    std::vector<double> farthest(voxels_.places.size());
    Pulse pulse;
    for (const std::uint32_t voxel : voxels_.places) {
      pulse.count(query_.b.hierarchy().storage().top.size() * kNodeChildren);
      farthest[voxel] = HWY_DYNAMIC_DISPATCH(farthestOfVoxelOnTarget)(query_, rule, voxel, sheet_);
    }
    std::stable_sort(voxels_.places.begin(), voxels_.places.end(),
                     [&](std::uint32_t x, std::uint32_t y) { return farthest[x] > farthest[y]; });
    return farthest[voxels_.places.front()];
  }

  /// As VoxelPasses has them.
  std::uint64_t spent() const { return voxels_.spent(); }
  void passes(const StopRule& rule, std::uint64_t tests)
  {
    voxels_.run(rule, tests, [this](const StopRule& own, std::uint32_t voxel) {
      return HWY_DYNAMIC_DISPATCH(measureVoxelOnTarget)(query_, own, voxel, sheet_);
    });
  }

private:
  const PointPairs pairs_;
  const DistancesQuery query_;
  const DistanceSheet sheet_;
  VoxelPasses<std::uint32_t, MeasuredVoxel> voxels_; ///< with points left
};

bool haveAnswers(const Placed& a, const Placed& b)
{
  return !a.hierarchy().empty() && !b.hierarchy().empty();
}

bool ofTriangles(const Placed& a, const Placed& b)
{
  return a.hierarchy().view().triangles || b.hierarchy().view().triangles;
}

/// Where a cloud is empty, nothing is near.
void finish(const Placed& a, const Placed& b, const PointDistancesRequest& request, PointDistances& result)
{
  if (!haveAnswers(a, b))
    for (Interval& interval : result.interval)
      if (!std::isnan(interval.lower)) interval = {request.max_distance, kInfinity};
  findGreatest(a, b, result);
  for (std::size_t i = 0; i < result.interval.size(); ++i)
    if (result.closest_point[i] == kNothing && result.interval[i].lower < request.max_distance) ++result.undecided;
}

std::size_t stepsOf(const Placed& a, const StopRule& rule)
{
  return a.hierarchy().storage().voxel_count * (rule.mayStop() ? rule.passes().size() : 1);
}

} // namespace

void pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request, PointDistances& result)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  const StopRule rule(request.accuracy);
  Progress progress(request.progress);
  PointDistances found = std::exchange(result, {}); // should something throw, it is empty
  clear(found, a, request);
  if (haveAnswers(a, b)) {
    progress.begin(1.0, stepsOf(a, rule));
    Direction(a, b, request, progress, found).passes(rule, rule.node_pairs);
    progress.end();
  }
  finish(a, b, request, found);
  result = std::move(found);
}

PointDistances pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request)
{
  PointDistances result;
  pointDistances(a, b, request, result);
  return result;
}

PointDistances pointDistances(const Placed& a, const std::vector<std::uint32_t>& records, const Placed& b,
                              const PointDistancesRequest& request)
{
  const std::vector<std::int32_t> subset(records.begin(), records.end());
  PointsView view = a.hierarchy().view();
  view.restrictTo(subset.data(), subset.size());
  const SphereHierarchy some(view);
  return pointDistances({some, a.pose}, b, request);
}

SymmetricDistances symmetricDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request)
{
  SymmetricDistances result;
  symmetricDistances(a, b, request, result);
  return result;
}

void symmetricDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request,
                        SymmetricDistances& result)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  const StopRule rule(request.accuracy);
  Progress progress(request.progress);
  SymmetricDistances found = std::exchange(result, {}); // should something throw, it is empty
  clear(found.a, a, request);
  clear(found.b, b, request);
  if (haveAnswers(a, b)) {
    progress.begin(1.0, stepsOf(a, rule) + stepsOf(b, rule));
    Direction from_a(a, b, request, progress, found.a), from_b(b, a, request, progress, found.b);
    if (rule.mayStop()) {
      passBothWithin(from_a, from_b, rule);
    }
    else {
      from_a.passes(rule, StopRule::kNever);
      from_b.passes(rule, StopRule::kNever);
    }
  }
  finish(a, b, request, found.a);
  finish(b, a, request, found.b);
  findHausdorff(a, b, found);
  if (request.accuracy.mode == Accuracy::Mode::tolerance)
    found.hausdorff_interval.lower = std::nextafter(found.hausdorff - request.accuracy.value, -kInfinity);
  if (found.hausdorff_pair && ofTriangles(a, b)) {
    const HausdorffDistance farthest =
        request.accuracy.stopsEarly() ? HausdorffDistance() : surfaceHausdorff(a, b, request);
    found.hausdorff = farthest.distance;
    found.hausdorff_pair = farthest.pair;
    found.hausdorff_interval = farthest.interval;
    found.hausdorff_work = farthest.work;
  }
  if (haveAnswers(a, b)) progress.end();
  result = std::move(found);
}

HausdorffDistance hausdorffDistance(const Placed& a, const Placed& b, const HausdorffRequest& hausdorff)
{
  PointDistancesRequest request;
  static_cast<Effort&>(request) = hausdorff;
  check(a, b, request);
  if (request.accuracy.stopsEarly())
    throw InvalidInput(Input::accuracy, "accuracy",
                       request.accuracy.text() + " stops early, which the Hausdorff distance does not",
                       "give exact or tolerance=LENGTH");
  const DefaultFloatEnvironment environment;
  request.accuracy = Accuracy::exact(); // of points
  const StopRule rule(request.accuracy);
  Progress progress(request.progress);
  HausdorffDistance result;
  if (!haveAnswers(a, b)) return result;
  if (ofTriangles(a, b)) {
    result = surfaceHausdorff(a, b, hausdorff);
    progress.finish();
    return result;
  }
  SymmetricDistances found;
  clear(found.a, a, request);
  clear(found.b, b, request);
  ReachedDistance reached;
  progress.begin(1.0, stepsOf(a, rule) + stepsOf(b, rule));
  Direction from_a(a, b, request, progress, found.a, &reached), from_b(b, a, request, progress, found.b, &reached);
  const bool a_first = from_a.sortFarthestFirst(rule) >= from_b.sortFarthestFirst(rule);
  (a_first ? from_a : from_b).passes(rule, StopRule::kNever);
  (a_first ? from_b : from_a).passes(rule, StopRule::kNever);
  progress.end();
  findGreatest(a, b, found.a);
  findGreatest(b, a, found.b);
  findGreatestOfBoth(a, b, found);
  result.distance = found.hausdorff;
  result.interval = {result.distance, result.distance};
  result.pair = found.hausdorff_pair;
  result.work = found.a.work;
  result.work += found.b.work;
  return result;
}

} // namespace pcl_bsh
#endif
