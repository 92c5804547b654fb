// SPDX-License-Identifier: BSD-3-Clause
// Data that all motions of a query share.
#pragma once

#include <pcl_bsh/geometry/rigid_motion.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/trajectory/query.h>

#include <vector>

namespace pcl_bsh {

/// A ball that holds all points of a body, with their radii, in the body's frame.
struct BodyBall {
  /// @param body not empty
  explicit BodyBall(const SphereHierarchy& body);

  Eigen::Vector3d center;
  double radius;
};

struct MotionsQuery {
  MotionsQuery(const Placed& scan_at, const SphereHierarchy& model_of, const MotionsRequest& asked);

  const Placed& scan;
  const SphereHierarchy& model;
  const MotionsRequest& request;
  const BodyBall body;     ///< of the model
  const BoxTree boxes;     ///< of the model
  TrajectoryRequest swept; ///< the request, about one motion
};

/// The motion between two poses, the same in both directions.
RigidMotion motionBetween(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other, const Point3& pivot);

/// Bounds how far any point of the body is, at any instant of a motion, from its place at the middle of the motion.
/// @param middle the pose at half of the motion
double extentAround(const Eigen::Isometry3d& middle, const RigidMotion& motion, const BodyBall& body);

/// Refuses values of the request, poses by their index, and motions that name no pose.
void check(const Placed& scan, const PoseList& poses, const std::vector<PoseMotion>& motions,
           const MotionsRequest& request);

/// Refuses motions that cannot be swept, the first one in the list, whatever their verdicts. @pre neither cloud is
/// empty
/// @param used the poses that motions name
void checkSwept(const MotionsQuery& query, const PoseList& poses, const std::vector<std::uint32_t>& used,
                const std::vector<PoseMotion>& motions);

} // namespace pcl_bsh
