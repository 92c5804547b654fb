// SPDX-License-Identifier: BSD-3-Clause
// The oracle: every query again, pair by pair in exact arithmetic. Quadratic; for tests and for doubt.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::brute_force {

/// Same contracts as their namesakes in collide.h. Work counts one exact decision per pair looked at; the witness of
/// anyCollision() is the smallest colliding (a, b).
AnyResult anyCollision(const Placed& a, const Placed& b, const AnyRequest& request);
FlagsResult collisionFlags(const Placed& a, const Placed& b, const FlagsRequest& request);
DistanceResult closestPair(const Placed& a, const Placed& b, const DistanceRequest& request = {});

/// As the others, but that it is exact whatever the accuracy, takes one thread and reports no progress.
PointDistances pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request = {});

} // namespace pcl_bsh::brute_force
PCL_BSH_EXPORT_END
