// SPDX-License-Identifier: BSD-3-Clause
// Closest pairs at many poses: the closest pair at one pose is a bound at the next.
#include <pcl_bsh/roadmap/collide_at_poses.h>
#include <pcl_bsh/roadmap/pose_tasks.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/roadmap/closest_at_poses.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/closest_search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

Work closestOfBatchOnTarget(const PoseBatch& batch, const std::uint32_t* order, DistancesAtPoses& result)
{
  Work work;
  std::optional<PointPair> last;
  for (std::size_t i = 0; i < batch.poses.size(); ++i) {
    const Placed b{batch.b, batch.poses[i]};
    ClosestSearch search(batch.a, b, Accuracy::exact(), NoOthers());
    const DistanceResult found = last ? search.runFrom(*last) : search.run();
    last = found.pair;
    result.distances[order[i]] = found.distance;
    result.pairs[order[i]] = *found.pair;
    work += found.work;
  }
  return work;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(closestOfBatchOnTarget);

DistancesAtPoses closestPairAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                                    const DistanceRequest& request, const PosesProgress& report)
{
  checkAtPoses(a, T_world_b, request.accuracy, request.threads);
  const DefaultFloatEnvironment environment;
  DistancesAtPoses result;
  result.distances.assign(T_world_b.size(), std::numeric_limits<double>::infinity());
  if (a.hierarchy().empty() || b.empty() || T_world_b.size() == 0) return result;
  Progress progress(report);
  result.pairs.resize(T_world_b.size());
  if (!request.accuracy.isExact()) {
    result.work = forEachPose(T_world_b, request.threads, progress, [&](std::size_t i, const Eigen::Isometry3d& pose) {
      const DistanceResult found = closestPair(a, {b, pose}, {request.accuracy});
      result.distances[i] = found.distance;
      result.pairs[i] = *found.pair;
      return found.work;
    });
    return result;
  }
  result.work =
      forEachBatch(a, b, T_world_b, request.threads, progress, [&](const PoseBatch& batch, const std::uint32_t* order) {
        return HWY_DYNAMIC_DISPATCH(closestOfBatchOnTarget)(batch, order, result);
      });
  return result;
}

} // namespace pcl_bsh
#endif
