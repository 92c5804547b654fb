// SPDX-License-Identifier: BSD-3-Clause
// Distances of all points: each voxel of a is one task and owns its points.
#include <pcl_bsh/distances/check_distances.h>
#include <pcl_bsh/distances/distance_query.h>
#include <pcl_bsh/hierarchy/kept_scratch.h>
#include <pcl_bsh/hierarchy/parallel.h>

#include <algorithm>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/distances/point_distances.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/distances/distance_walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

MeasuredVoxel measureVoxelOnTarget(const DistanceQuery& query, const StopRule& rule, std::uint32_t voxel,
                                   const DistanceSheet& sheet, Progress& progress)
{
  const ScratchLease<DistanceScratch> scratch;
  DistanceWalk walk(query, rule, sheet, progress, *scratch);
  walk.run(voxel);
  return walk.found;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {

HWY_EXPORT(measureVoxelOnTarget);

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

/// Memory of one query after another, to be had by a ScratchLease.
struct PartScratch {
  std::vector<std::uint32_t> voxels;
  std::vector<MeasuredVoxel> parts;

  std::size_t bytes() const noexcept
  {
    return voxels.capacity() * sizeof(std::uint32_t) + parts.capacity() * sizeof(MeasuredVoxel);
  }
};

/// The voxels of a with points that are not measured yet, from pass to pass.
class Measuring {
public:
  Measuring(const DistanceQuery& query, const DistanceSheet& sheet, unsigned threads, Progress& progress, Work& work)
  : query_(query),
    sheet_(sheet),
    threads_(threads),
    progress_(progress),
    work_(work),
    voxels_((*scratch_).voxels),
    parts_((*scratch_).parts)
  {
    voxels_.resize(query.a.hierarchy().storage().voxel_count);
    for (std::uint32_t v = 0; v < voxels_.size(); ++v) voxels_[v] = v;
  }

  bool done() const { return voxels_.empty(); }

  /// Sphere tests so far.
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
  void pass(const StopRule& rule)
  {
    parts_.assign(voxels_.size(), MeasuredVoxel());
    const auto walk = [&](std::size_t i, const StopRule& own) {
      if (progress_.stopped()) return;
      parts_[i] = HWY_DYNAMIC_DISPATCH(measureVoxelOnTarget)(query_, own, voxels_[i], sheet_, progress_);
      progress_.step();
    };
    if (rule.node_pairs == StopRule::kNever) {
      parallelFor(voxels_.size(), threads_, [&](std::size_t i) { walk(i, rule); });
    }
    else { // one after another: what one leaves is the next one's
      StopRule own = rule;
      for (std::size_t i = 0; i < voxels_.size(); ++i) {
        walk(i, own);
        own.node_pairs -= std::min(own.node_pairs, parts_[i].work.node_pairs);
      }
    }
    progress_.throwIfStopped();
    std::size_t left = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      work_ += parts_[i].work;
      spent_ += parts_[i].work.node_pairs;
      if (parts_[i].undecided) voxels_[left++] = voxels_[i];
    }
    voxels_.resize(left);
  }

  const ScratchLease<PartScratch> scratch_;
  const DistanceQuery& query_;
  const DistanceSheet& sheet_;
  const unsigned threads_;
  Progress& progress_;
  Work& work_;
  std::vector<std::uint32_t>& voxels_; ///< with points left
  std::vector<MeasuredVoxel>& parts_;  ///< of the last pass
  std::uint64_t spent_ = 0;
};

/// Empties the result, and its arrays keep their memory; begins with nothing measured.
void clear(PointDistances& result, const Placed& a, const PointDistancesRequest& request)
{
  PointDistances fresh;
  fresh.distance.swap(result.distance);
  fresh.nearest.swap(result.nearest);
  fresh.interval.swap(result.interval);
  result = PointDistances(); // should something throw
  const SphereHierarchy& cloud = a.hierarchy();
  fresh.distance.assign(cloud.view().count, kNoDistance);
  fresh.nearest.assign(cloud.view().count, PointDistances::kNoPoint);
  fresh.interval.clear();
  if (!request.accuracy.isExact() && request.accuracy.isProven()) {
    fresh.interval.assign(cloud.view().count, {kNoDistance, kNoDistance});
    for (std::size_t v = 0; v < cloud.storage().voxel_count; ++v)
      cloud.storage().forEachRecord(v, [&](std::uint32_t record) { fresh.interval[record] = Interval(); });
  }
  result = std::move(fresh);
}

/// One direction of a request.
class Direction {
public:
  Direction(const Placed& a, const Placed& b, const PointDistancesRequest& request, Progress& progress,
            PointDistances& result)
  : pairs_(a, b, request.max_distance),
    query_{a,
           b,
           pairs_,
           RelativeRotation(a.pose, b.pose),
           request.accuracy.mode == Accuracy::Mode::tolerance ? request.accuracy.value : 0.0,
           request.accuracy.isProven()},
    sheet_{result.distance.data(), result.nearest.data(), result.interval.empty() ? nullptr : result.interval.data()},
    measuring(query_, sheet_, threadCount(request.threads), progress, result.work)
  {
  }

private:
  const PointPairs pairs_;
  const DistanceQuery query_;
  const DistanceSheet sheet_;

public:
  Measuring measuring;
};

bool haveAnswers(const Placed& a, const Placed& b)
{
  return !a.hierarchy().empty() && !b.hierarchy().empty();
}

/// Where a cloud is empty, nothing is near.
void finish(const Placed& a, const Placed& b, const PointDistancesRequest& request, PointDistances& result)
{
  if (!haveAnswers(a, b))
    for (Interval& interval : result.interval)
      if (!std::isnan(interval.lower)) interval = {request.max_distance, kInfinity};
  findGreatest(a, b, result);
  for (std::size_t i = 0; i < result.interval.size(); ++i)
    if (result.nearest[i] == PointDistances::kNoPoint && result.interval[i].lower < request.max_distance)
      ++result.undecided;
}

std::size_t stepsOf(const Placed& a, const StopRule& rule)
{
  return a.hierarchy().storage().voxel_count * (rule.mayStop() ? rule.passes().size() : 1);
}

/// Both clouds share the budget: each has half of it, and what one leaves is the other's.
void measureBothWithin(Measuring& a, Measuring& b, const StopRule& rule)
{
  const StopRule half = rule.part(0.5);
  a.passes(half, half.node_pairs);
  const std::uint64_t left = rule.node_pairs - std::min(rule.node_pairs, a.spent());
  b.passes(rule, rule.node_pairs == StopRule::kNever || !a.done() ? half.node_pairs : std::max(half.node_pairs, left));
  if (rule.isTimed()) a.passes(rule, StopRule::kNever);
}

} // namespace

void pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request, PointDistances& result)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  const StopRule rule(request.accuracy);
  Progress progress(request.progress);
  clear(result, a, request);
  PointDistances found;
  std::swap(found, result); // should something throw, it is empty
  if (haveAnswers(a, b)) {
    progress.begin(1.0, stepsOf(a, rule));
    Direction(a, b, request, progress, found).measuring.passes(rule, rule.node_pairs);
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

SymmetricDistances symmetricDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  const StopRule rule(request.accuracy);
  Progress progress(request.progress);
  SymmetricDistances result;
  clear(result.a, a, request);
  clear(result.b, b, request);
  if (haveAnswers(a, b)) {
    progress.begin(1.0, stepsOf(a, rule) + stepsOf(b, rule));
    Direction from_a(a, b, request, progress, result.a), from_b(b, a, request, progress, result.b);
    if (rule.mayStop()) {
      measureBothWithin(from_a.measuring, from_b.measuring, rule);
    }
    else {
      from_a.measuring.passes(rule, StopRule::kNever);
      from_b.measuring.passes(rule, StopRule::kNever);
    }
    progress.end();
  }
  finish(a, b, request, result.a);
  finish(b, a, request, result.b);
  findHausdorff(a, b, result);
  return result;
}

} // namespace pcl_bsh
#endif
