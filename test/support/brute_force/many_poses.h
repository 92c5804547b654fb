// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>

namespace pcl_bsh::brute_force {

/// The oracle, pose by pose and pair by pair in exact arithmetic.
AnyAtPoses anyCollisionAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                               const AnyRequest& request = {});
DistancesAtPoses closestPairAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                                    const DistanceRequest& request = {});

/// The oracle, motion by motion and pair by pair. Between clearance and clearance + `swept` its verdicts may differ.
AnyOnMotions anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                                   const std::vector<PoseMotion>& motions, const MotionsRequest& request);

} // namespace pcl_bsh::brute_force
