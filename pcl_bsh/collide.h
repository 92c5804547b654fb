// SPDX-License-Identifier: BSD-3-Clause
// Where do two posed clouds collide? Any pair, flags per point, smallest distance; all exact.
//
//   SphereHierarchy hall(viewOf(hall_xyz, n)), robot(viewOf(robot_xyz, m));
//   FlagsRequest request;
//   request.clearance = 0.05;                                        // in the clouds' unit; touching counts
//   FlagsResult hit = collisionFlags({hall}, {robot, T_world_robot}, request);
//   DistanceResult nearest = closestPair({hall}, {robot, T_world_robot});
//
// Point p of a and q of b collide iff |T_a p - T_b q| <= clearance (+ their radii), decided as exact arithmetic on the
// given numbers decides it. The same input gives the same answer, bit for bit, for any thread count and SIMD target.
#pragma once

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
