// SPDX-License-Identifier: BSD-3-Clause
// Any pair: done at the first witness.
#include <pcl_bsh/query/collide.h>
#include <pcl_bsh/query/interval_search.h>
#include <pcl_bsh/query/request_check.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/query/any_collision.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/query/any_search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

AnyResult anyCollisionOnTarget(const Placed& a, const Placed& b, const CollisionRequest& request)
{
  return AnySearch(a, b, request, Unwatched{}).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(anyCollisionOnTarget);

AnyResult anyCollision(const Placed& a, const Placed& b, const CollisionRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  if (request.accuracy.stopsEarly()) {
    const IntervalFinding found = searchInterval(a, b, request.accuracy, request.clearance);
    const bool colliding = found.verdict == Verdict::colliding;
    return {found.verdict, colliding ? found.pair : std::nullopt, found.distance, found.work};
  }
  return HWY_DYNAMIC_DISPATCH(anyCollisionOnTarget)(a, b, request);
}

} // namespace pcl_bsh
#endif
