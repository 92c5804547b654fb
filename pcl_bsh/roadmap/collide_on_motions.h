// SPDX-License-Identifier: BSD-3-Clause
// Many motions of one cloud past another: the edges of which planners ask whether they are free.
//
//   std::vector<Eigen::Isometry3d> vertices = ...;                // T_world_robot
//   std::vector<PoseMotion> edges = {{0, 1}, {0, 2}};             // from vertex to vertex
//   MotionsRequest request;
//   request.clearance = 0.05;                                     // in the clouds' unit; touching counts
//   request.swept = 0.001;
//   request.threads = 0;                                          // all of the machine's
//   AnyOnMotions found = anyCollisionOnMotions({hall}, robot, vertices, edges, request);
//
// A motion is that of a swept trajectory (trajectory.h): its pivot moves in a straight line while the model turns at
// constant speed about a fixed axis, in the shorter direction. A motion reported free stays farther than the clearance
// at every instant, at its two poses exactly as they are; one reported colliding comes within clearance + `swept`.
// A motion has the same verdict in both directions, wherever it stands in the list, whatever else the list holds, and
// for any number of threads and any processor. Where points have uncertainties (PointsView), a motion is free if no
// pair can come within the clearance on it, colliding if some pair does, within clearance + `swept`, wherever its
// points truly are, and else undecided. In one of its directions it is that of collideAlong(); between clearance and
// clearance + `swept` those of the two directions may differ.
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/pose_list.h>
#include <pcl_bsh/query/result.h>

#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// From one pose of a list to another, by their indices. Both may be the same.
struct PoseMotion {
  std::uint32_t from = 0, to = 0;
};

/// What anyCollisionOnMotions() reads. `swept` is all that it may be off: no accuracy but exact.
struct MotionsRequest : Effort {
  double clearance = 0.0;   ///< finite, >= 0; inclusive
  double swept = 0.0;       ///< to this tolerance: finite, > 0, has to be given
  Point3 pivot = {0, 0, 0}; ///< the point of the model that moves in straight lines
};

/// What anyCollisionOnMotions() found.
struct AnyOnMotions {
  /// One per motion; undecided only where points have uncertainties.
  std::vector<Verdict> flags;
  std::size_t colliding = 0; ///< motions that are
  std::size_t undecided = 0;
  Work work;
};

/// Does any point of the scan collide with one of the model, on each of the motions?
/// @param poses T_world_model, rigid within 1e-6: vertices of a roadmap, say, which many motions share. What only
///   collides at a pose is found once for all motions that begin or end there.
/// @throws std::invalid_argument naming the value: a clearance, `swept`, pivot or pose that is not what its
///   declaration asks for (a pose by its index); by its index a motion that names no pose of the list, that is half a
///   turn (both directions are as short: give a pose between), or that collideAlong() would refuse for `swept`.
///   Cancelled.
AnyOnMotions anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                                   const std::vector<PoseMotion>& motions, const MotionsRequest& request);

/// The same into a result whose memory is used again; it is empty should anything be thrown.
void anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                           const std::vector<PoseMotion>& motions, const MotionsRequest& request, AnyOnMotions& result);
} // namespace pcl_bsh
PCL_BSH_EXPORT_END
