// SPDX-License-Identifier: BSD-3-Clause
// Along a path: which points of a scan does a model come near to, how near, and when?
//
//   SphereHierarchy tunnel(viewOf(tunnel_xyz, n)), wagon(viewOf(wagon_xyz, m));
//   TrajectoryRequest request;
//   request.clearance = 0.05;                                            // in the clouds' unit; touching counts
//   TrajectoryResult run = collideAlong({tunnel}, wagon, wagon_poses, request);
//
// Point p of the scan collides at pose k iff |T_scan p - T_k q| <= clearance (+ radii) for a point q of the model. The
// decision is that of exact arithmetic on the given numbers. Records may be triangles (triangles_view.h), on either
// side: then p and q are any of their places. Equal input gives equal answers, bit for bit, for any number of threads
// and any processor.
//
// Swept: the motion between consecutive poses counts, too, to a tolerance. The model's pivot moves in a straight line
// while the model turns at constant speed about a fixed axis: poseBetween(). A point reported free stays farther than
// the clearance during the whole motion, at the given poses exactly as they are; one reported colliding comes within
// clearance + tolerance. From one pose to the next the model turns in the shorter direction, by less than half a turn.
// Half a turn is refused: both directions are as short. More than half a turn needs poses between.
//
// Where points have uncertainties (PointsView), a point collides if at some pose it is within the clearance of a point
// of the model wherever both truly are. It is free if this is possible at no pose. Else it is undecided. Swept, a point
// is free if it cannot come within the clearance during the motion. It collides if it surely comes within clearance +
// tolerance. Uncertain points cost about two queries; a budget is divided between them.
//
// An answer does not depend on what else is asked for. (Where the accuracy is a tolerance, pairs that may count or not
// may do so for one question and not for another.)
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/query/result.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The request of collideAlong(). With an accuracy `tolerance`, a pair at a distance in (clearance, clearance +
/// tolerance] may count or not, at each pose anew. If a point has only such pairs, its distance is within the tolerance
/// of the smallest. Accuracies that stop early (level, pairs, time) decide flags only, and leave some undecided. Swept
/// motion has a tolerance of its own, and takes only the accuracy `exact`. Progress is reported also while nothing is
/// near.
struct TrajectoryRequest : Effort {
  double clearance = 0.0;      ///< finite, >= 0; inclusive
  bool flags = true;           ///< per scan point: does it collide at any pose?
  bool distances = false;      ///< per colliding scan point: the smallest distance over all poses
  bool first_poses = false;    ///< per colliding scan point: the first pose at which it collides
  bool closest_poses = false;  ///< per colliding scan point: the pose of smallest distance, of several the first
  bool pose_summaries = false; ///< per pose: how many points collide, and the smallest distance; not with `swept`
  std::optional<double> swept; ///< finite, > 0: the motion between poses too, to this tolerance
  Point3 pivot = {0, 0, 0};    ///< swept: the point of the model that moves in straight lines
};

/// The model at one pose.
struct PoseSummary {
  bool colliding = false;
  std::size_t colliding_points = 0; ///< points of the scan
  std::size_t undecided_points = 0; ///< points that may collide, but not for certain: places are uncertain
  /// Smallest distance of any pair that may collide, as measured; infinity when there is no such pair.
  double distance = std::numeric_limits<double>::infinity();

  /// Adds the summary of other points at the same pose.
  PoseSummary& operator+=(const PoseSummary& more)
  {
    colliding = colliding || more.colliding;
    colliding_points += more.colliding_points;
    undecided_points += more.undecided_points;
    distance = std::min(distance, more.distance);
    return *this;
  }
};

/// An instant of the motion: `fraction` in [0, 1) of the motion from `pose` to the next; 0 at the last pose.
struct FirstContact {
  std::size_t pose = 0;
  double fraction = 0.0;
};

/// Vectors have one entry per record of the scan's view, and are empty unless asked for.
///
/// Where points are uncertain, distances, first and closest poses and the first contact are those of all that may
/// collide: points that collide or are undecided, and pairs that may be within the clearance. Distances are those
/// between measured places.
///
/// When swept, a distance is within half the tolerance of the smallest during the motion, and a pose's number k stands
/// for the motion from pose k to pose k + 1.
struct TrajectoryResult {
  std::vector<Verdict> flags;               ///< undecided only where the accuracy lets the walk stop early, or places
                                            ///< are uncertain
  std::size_t colliding = 0;                ///< points that collide; 0 when nothing is asked for
  std::size_t undecided = 0;                ///< points that are undecided
  std::vector<float> distance;              ///< less the radii; the float nearest to the distance in double; NaN: free
  std::vector<std::int32_t> first_pose;     ///< kNothing (-1) where free
  std::vector<std::int32_t> closest_pose;   ///< kNothing (-1) where free
  std::vector<std::uint32_t> closest_point; ///< with distances or closest_poses: the record of the model that realises
                                            ///< the distance at the closest pose, of several the smallest;
                                            ///< kNothing where free
  /// With distances, where a solid was added that holds anything (question/enclosed.h): for each record whose distance
  /// a solid makes negative, or may, an interval that certainly holds it. NaN for other records. Otherwise empty.
  std::vector<Interval> interval;
  std::vector<std::int32_t> certain_pose; ///< with first_poses, where points are uncertain: the first pose at which a
                                          ///< point collides for certain; kNothing where at none
  std::vector<PoseSummary> poses;         ///< one per pose
  /// Swept: before this instant no pair comes within the clearance; at it a pair is within clearance + tolerance. Empty
  /// when all points are free.
  std::optional<FirstContact> first_contact;
  std::optional<FirstContact> certain_contact; ///< the first one for certain, where points are uncertain
  Work work;                                   ///< leaf pairs count once per pose they were compared at
};

/// The model at each of `model_poses` (T_world_model, rigid within 1e-6), against the scan at its pose.
/// @throws std::invalid_argument naming the value: a clearance, accuracy, tolerance, pivot or pose that is not what its
///   declaration asks for (a pose by its index); swept: half a turn from one pose to the next, coordinates of 2^100 and
///   more, a tolerance too small for the size of the coordinates (some 1e-12 of it), or for the motion (which may be
///   cut into 4,194,304 parts; it is refused before any memory is taken); 2^31 poses and more. Cancelled.
TrajectoryResult collideAlong(const Placed& scan, const SphereHierarchy& model,
                              const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request);

/// Writes into a result whose memory is used again. The result is empty if anything is thrown.
void collideAlong(const Placed& scan, const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& model_poses,
                  const TrajectoryRequest& request, TrajectoryResult& result);

/// Returns the pose at `fraction` in [0, 1] of the motion from one pose to the next. The pivot, a point in the frame
/// that the poses place, moves in a straight line at constant speed. The rotation turns at constant speed about a fixed
/// axis, in the shorter direction. At 0 and 1 exactly the poses given; their deviation from rigid poses (1e-6 at most)
/// changes linearly between them.
/// @throws std::invalid_argument between poses that are half a turn apart: both directions are as short.
Eigen::Isometry3d poseBetween(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double fraction,
                              const Point3& pivot = {0, 0, 0});

namespace brute_force {

/// The oracle, pair by pair and pose by pose in exact arithmetic. @throws also when request.swept is set.
TrajectoryResult collideAlong(const Placed& scan, const SphereHierarchy& model,
                              const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& request);

} // namespace brute_force
} // namespace pcl_bsh
PCL_BSH_EXPORT_END
