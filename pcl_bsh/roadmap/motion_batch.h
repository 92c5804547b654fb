// SPDX-License-Identifier: BSD-3-Clause
// Motions near each other, which one task answers.
#pragma once

#include <pcl_bsh/geometry/rigid_motion.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/reach.h>
#include <pcl_bsh/roadmap/collide_on_motions.h>
#include <pcl_bsh/roadmap/pose_batch.h>
#include <pcl_bsh/trajectory/query.h>

#include <optional>
#include <vector>

namespace pcl_bsh {

/// What all motions of a query share.
struct MotionsQuery {
  /// Asks at first about what may collide.
  MotionsQuery(const Placed& scan_at, const SphereHierarchy& model_of, const MotionsRequest& asked);

  const Placed& scan;
  const SphereHierarchy& model;
  const MotionsRequest& request;
  const BoxTree boxes;     ///< of the model
  TrajectoryRequest swept; ///< the same, of one motion

  /// From now on, points are where `where` says.
  void ask(Places where);

  Places places = Places::measured;
  double beyond = 0.0; ///< pairs farther apart than this never count as colliding
};

/// The motion between two poses, the same in both directions.
RigidMotion motionBetween(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other, const Point3& pivot);

/// At least how far any point of the body gets, during a motion, from where it is at the pose of its middle.
double extentAround(const Eigen::Isometry3d& middle, const RigidMotion& motion, const BodyBall& body);

/// Whether the pair collides at that instant of the motion which a straight line between its ends suggests. Where not,
/// it may collide at another one.
bool collidesDuring(const MotionsQuery& query, const RigidMotion& motion, const PointPair& pair, Work& work);

/// A pair that comes near enough during the motion to count as colliding. It is found if and only if there is one.
/// @param path scratch memory
std::optional<PointPair> findOnMotion(const MotionsQuery& query, const RigidMotion& motion, Progress& progress,
                                      Work& work);

struct MotionBatch {
  const MotionsQuery& query;
  PoseBatch middles; ///< of the motions, and how far they get from there
  std::vector<RigidMotion> motions;
};

/// Marks those of the batch's motions that collide.
Work anyOfMotionBatch(const MotionBatch& batch, bool* collides, Progress& progress);

} // namespace pcl_bsh
