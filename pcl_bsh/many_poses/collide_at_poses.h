// SPDX-License-Identifier: BSD-3-Clause
// One cloud at each of many poses against another: what planners and samplers ask by the million.
//
//   std::vector<Eigen::Isometry3d> samples = ...;                      // T_world_robot
//   AnyRequest request;
//   request.clearance = 0.05;
//   request.threads = 0;                                               // all of the machine's
//   AnyAtPoses found = anyCollisionAtPoses({hall}, robot, samples, request);
//
// Every answer is the one of the single query at that pose, for any order of the list and any number of threads.
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/query/pose_list.h>

#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The result of anyCollisionAtPoses().
struct AnyAtPoses {
  /// One per pose; undecided only where points have uncertainties: some pair may be within the clearance, but none is
  /// wherever its points truly are.
  std::vector<Verdict> flags;
  std::size_t colliding = 0; ///< poses that are
  std::size_t undecided = 0;
  Work work;
};

/// The result of closestPairAtPoses().
struct DistancesAtPoses {
  /// One per pose: what closestPair() answers there.
  std::vector<double> distances;
  /// The closest pair at each pose; kNothing where no pair is within max_distance. Empty when a cloud has no finite
  /// point.
  std::vector<PointPair> pairs;
  Work work;
};

/// Does any pair of points collide, b at each of the poses T_world_b (rigid within 1e-6)? Returns verdicts alone: the
/// witness of a pose is tried first at the next one. anyCollision() returns the witness of one pose.
/// @throws std::invalid_argument naming the value: a clearance or a pose that is not what its declaration asks for (a
///   pose by its index), an accuracy that stops early. Cancelled.
AnyAtPoses anyCollisionAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                               const AnyRequest& request = {});

/// Fills a result, whose memory is used again; it is empty after an exception.
void anyCollisionAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                         const AnyRequest& request, AnyAtPoses& result);

/// The smallest distance and the pair that realises it, b at each of the poses.
/// @throws as anyCollisionAtPoses()
DistancesAtPoses closestPairAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                                    const DistanceRequest& request = {});

/// Fills a result, whose memory is used again; it is empty after an exception.
void closestPairAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                        const DistanceRequest& request, DistancesAtPoses& result);
} // namespace pcl_bsh
PCL_BSH_EXPORT_END
