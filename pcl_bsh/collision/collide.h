// SPDX-License-Identifier: BSD-3-Clause
// Where do two posed clouds collide? Any pair, flags per point, smallest distance; all exact.
//
//   SphereHierarchy hall(viewOf(hall_xyz, n)), robot(viewOf(robot_xyz, m));
//   CollisionRequest request;
//   request.clearance = 0.05;                                        // in the clouds' unit; touching counts
//   FlagsResult hit = collisionFlags({hall}, {robot, T_world_robot}, request);
//
// Point p of a and q of b collide iff |T_a p - T_b q| <= clearance (+ their radii), decided as exact arithmetic on the
// given numbers decides it. The same input gives the same answer, bit for bit, for any thread count and SIMD target.
#pragma once

#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

namespace pcl_bsh {

enum class Side : std::uint8_t { a = 1, b = 2, both = 3 };

struct CollisionRequest {
  double clearance = 0.0; ///< finite, >= 0; inclusive
  Side flagged = Side::a; ///< whose points collisionFlags() flags
  unsigned threads = 1;   ///< 0: all of the machine's
  Accuracy accuracy;      ///< exact, unless the caller asks for less
};

/// Does any pair of points collide? Stops at the first witness.
/// @throws std::invalid_argument when the clearance or a pose is not what its declaration asks for.
AnyResult anyCollision(const Placed& a, const Placed& b, const CollisionRequest& request);

/// Which points collide with something of the other cloud? Throws as anyCollision() does.
FlagsResult collisionFlags(const Placed& a, const Placed& b, const CollisionRequest& request);

/// The same into a result whose memory is used again: for one pose after another.
void collisionFlags(const Placed& a, const Placed& b, const CollisionRequest& request, FlagsResult& result);

/// The smallest distance and the pair that realises it; the clearance plays no part. Throws as anyCollision() does.
DistanceResult closestPair(const Placed& a, const Placed& b, const CollisionRequest& request = {});

} // namespace pcl_bsh
