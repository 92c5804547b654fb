// SPDX-License-Identifier: BSD-3-Clause
// All queries of two clouds: where do they collide? Any pair, flags per point, distances, along paths, at many poses;
// all exact. Each has a header of its own, too. Many objects: scene/scene.h.
//
//   SphereHierarchy hall(viewOf(hall_xyz, n)), robot(viewOf(robot_xyz, m));
//   FlagsRequest request;
//   request.clearance = 0.05;                                        // in the clouds' unit; touching counts
//   FlagsResult hit = collisionFlags({hall}, {robot, T_world_robot}, request);
//   DistanceResult nearest = closestPair({hall}, {robot, T_world_robot});
//
// Point p of a and q of b collide iff |T_a p - T_b q| <= clearance (+ their radii), decided as exact arithmetic on the
// given numbers decides it. Equal input gives an equal answer, bit for bit, for any thread count and SIMD target.
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/seen/seen_space.h>
#include <pcl_bsh/seen/unseen_points.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/trajectory/trajectory.h>
