// SPDX-License-Identifier: BSD-3-Clause
// One search by several threads.
#pragma once

#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/query/reach.h>

namespace pcl_bsh {

/// What anyCollision() and closestPair() answer, by so many threads. A search that is soon over is that of one.
/// @param request checked; its accuracy does not stop early, and of a distance is exact
AnyResult anyCollisionShared(const Placed& a, const Placed& b, const AnyRequest& request, Places places,
                             unsigned threads);
DistanceResult closestPairShared(const Placed& a, const Placed& b, const DistanceRequest& request, unsigned threads);

} // namespace pcl_bsh
