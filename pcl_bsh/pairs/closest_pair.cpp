// SPDX-License-Identifier: BSD-3-Clause
// The closest pair, by one thread or by several.
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/pairs/check_request.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/pairs/interval_search.h>
#include <pcl_bsh/pairs/shared_search.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/closest_pair.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/closest_search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

DistanceResult closestPairOnTarget(const Placed& a, const Placed& b, const Accuracy& accuracy)
{
  return ClosestSearch(a, b, accuracy, NoOthers()).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(closestPairOnTarget);

DistanceResult closestPair(const Placed& a, const Placed& b, const DistanceRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  if (request.accuracy.stopsEarly()) {
    const IntervalFinding found = searchInterval(a, b, StopRule(request.accuracy), std::nullopt);
    const double gap = found.pair ? PointPairs(a, b, 0.0).gap(*found.pair) : std::numeric_limits<double>::infinity();
    return {gap, found.pair, found.distance, found.work};
  }
  const unsigned threads = request.accuracy.isExact() ? threadCount(request.threads) : 1;
  if (threads > 1) return closestPairShared(a, b, request, threads);
  return HWY_DYNAMIC_DISPATCH(closestPairOnTarget)(a, b, request.accuracy);
}

} // namespace pcl_bsh
#endif
