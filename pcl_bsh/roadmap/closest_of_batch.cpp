// SPDX-License-Identifier: BSD-3-Clause
// Closest pairs at poses near each other: that of one pose is a bound at the next. In a file of its own, for compilers
// inline less where one file has both searches.
#include <pcl_bsh/roadmap/pose_batch.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/roadmap/closest_of_batch.cpp"
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
    ClosestSearch search(batch.a, b, ClosestGoal(Accuracy::exact()), NoOthers());
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

Work closestOfBatch(const PoseBatch& batch, const std::uint32_t* order, DistancesAtPoses& result)
{
  return HWY_DYNAMIC_DISPATCH(closestOfBatchOnTarget)(batch, order, result);
}

} // namespace pcl_bsh
#endif
