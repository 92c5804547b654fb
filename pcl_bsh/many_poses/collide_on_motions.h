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
// A motion is that of a swept trajectory (trajectory.h). Its pivot moves straight while the model turns at constant
// speed about a fixed axis, in the shorter direction. A motion reported free stays farther than the clearance at every
// instant, at its two poses exactly as they are; one reported colliding comes within clearance + `swept`. A motion has
// one verdict in both directions, wherever it stands in the list, whatever else the list holds, for any number of
// threads and any processor. Points may have uncertainties (PointsView). Then a motion is free if no pair can come
// within the clearance on it. It collides if some pair surely comes within clearance + `swept`. Otherwise it is
// undecided. In one of the two directions collideAlong() has the same verdict. In the other direction it may have
// another one where the distance is between clearance and clearance + `swept`.
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

/// The request of anyCollisionOnMotions(). Answers may be off by `swept` alone: the accuracy has to be exact.
struct MotionsRequest : Effort {
  double clearance = 0.0;   ///< finite, >= 0; inclusive
  double swept = 0.0;       ///< to this tolerance: finite, > 0, has to be given
  Point3 pivot = {0, 0, 0}; ///< the point of the model that moves in straight lines
};

/// The result of anyCollisionOnMotions().
struct AnyOnMotions {
  /// One per motion; undecided only where points have uncertainties.
  std::vector<Verdict> flags;
  std::size_t colliding = 0; ///< motions that are
  std::size_t undecided = 0;
  Work work;
};

/// Does any point of the scan collide with one of the model, on each of the motions?
/// @param poses T_world_model, rigid within 1e-6: vertices of a roadmap, say, which many motions share. A collision at
///   a pose is found once for all motions that begin or end there.
/// @throws std::invalid_argument naming the value: a clearance, `swept`, pivot or pose (by its index) that is
///   not as declared. By its index, a motion that names no pose of the list, or that collideAlong() would
///   refuse for `swept`. Half a turn is refused: both directions are as short, so give a pose between.
///   Cancelled.
AnyOnMotions anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                                   const std::vector<PoseMotion>& motions, const MotionsRequest& request);

/// Fills a result, whose memory is used again; it is empty after an exception.
void anyCollisionOnMotions(const Placed& scan, const SphereHierarchy& model, const PoseList& poses,
                           const std::vector<PoseMotion>& motions, const MotionsRequest& request, AnyOnMotions& result);
} // namespace pcl_bsh
PCL_BSH_EXPORT_END
