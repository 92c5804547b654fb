// SPDX-License-Identifier: BSD-3-Clause
// The data that all voxels of the scan share along a trajectory, with the result that they write to.
#pragma once

#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/trajectory/boxes/box_tree.h>
#include <pcl_bsh/trajectory/pose_path.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <mutex>
#include <span>

namespace pcl_bsh {

/// The smallest distance at a pose, so far.
struct NearestAtPose {
  PointPair pair;
  bool found = false;
};

/// A voxel of the scan, and an interval of the path during which it may be near the model.
struct NearVoxel {
  std::uint32_t voxel, interval;
};

/// The answer that a walk looks for.
enum class Wanted : std::uint8_t {
  points,  ///< the answers of the request about each point
  witness, ///< swept: one pair that collides, and nothing else
};

/// The question, and the data for its answer that no voxel changes.
struct TrajectoryQuery {
  /// @param model_boxes the boxes of the model. @param where the places that are meant of uncertain points
  TrajectoryQuery(const Placed& scan_at, const SphereHierarchy& model_of, const BoxTree& model_boxes,
                  const std::vector<Eigen::Isometry3d>& model_poses, const TrajectoryRequest& asked,
                  TrajectoryResult& into, Progress& progress, MeantPlaces where = MeantPlaces::measured,
                  Wanted what = Wanted::points);

  const Placed& scan;
  const SphereHierarchy& model;
  const std::vector<Eigen::Isometry3d>& given;
  const TrajectoryRequest& request;
  TrajectoryResult& result;

  const BoxTree& boxes;
  const Reach between;      ///< bounds the reach of all pairs, radii not included
  const PairReach of_pairs; ///< the reach of each pair, radii included
  const bool of_points;     ///< whether both clouds are points: neither balls nor triangles
  const double reach;       ///< the greatest distance at which two records matter: see reachOf()
  const PosePath path;
  const bool certain;        ///< looks for points that collide wherever uncertain points truly are
  const bool witness;        ///< the walk ends at the first pair that collides
  const bool closest, first; ///< answers about each point, besides whether it collides
  /// Whether the nearest pair so far bounds the search for a point on a path that begins at `from`: farther pairs
  /// change no answer then. False where the point may collide earlier than is known, or where pairs count for their
  /// poses.
  bool bestBounds(double first_contact, double from) const
  {
    return closest && !request.pose_summaries && (!first || first_contact <= from);
  }
  /// Whether the nearest pair of a point collides if any of its pairs does.
  bool nearestDecides() const { return of_pairs.isOne(); }

  /// Swept: how near a pair of points counts as a contact; below 0 where it does at no distance.
  double nearEnough(PointPair pair) const;

  /// Returns the caller's pose for path index k.
  const Eigen::Isometry3d& poseAt(std::uint32_t k) const { return given[path.poses[k].given]; }

  /// Whether a point that collides may still change answers: nearest pairs, or summaries of poses, are asked for.
  bool everything() const { return closest || request.pose_summaries; }

  /// Bounds the rounding of double arithmetic in the place of a scan's point seen by the model.
  /// @param origin of its voxel, in the world
  double error(const Point3& origin) const;

  /// Whether floats can hold the places and lengths that a walk compares. Where not, every pair is compared.
  bool inFloatRange() const;

  /// All voxels that may be near the model, each with its intervals in their order. Once the rule's time is over, all
  /// intervals not yet tested are included.
  std::vector<NearVoxel> nearVoxels(const StopRule& rule, Progress& progress) const;

  mutable std::mutex mutex; ///< guards the members below, and the result's number of colliding points
  mutable std::vector<NearestAtPose> nearest_at_pose;
  mutable std::vector<std::size_t> pose_counts;
  mutable double earliest = std::numeric_limits<double>::infinity(); ///< swept: pose of the path plus fraction of
                                                                     ///< the motion to the next

private:
  struct WorldSphere {
    Point3 center; ///< in the world
    double radius;
  };

  bool near(const WorldSphere& sphere, const PathInterval& interval, double& stray) const;
  void collectNear(std::uint32_t node, std::uint32_t lane, std::uint32_t interval, const StopRule& rule,
                   Progress& progress, std::vector<NearVoxel>& near_voxels) const;
};

/// Returns how the model travels along its own axes, and turns. @param center the point of the model whose way counts
Travel travelOf(const std::vector<Eigen::Isometry3d>& poses, const Point3& center);

/// The largest coordinate of the model's middle and of the pivot at a pose.
double farthestPlace(const Eigen::Isometry3d& pose, const BoxTree& boxes, const Point3& pivot);

/// Swept: requires that the rounding of double arithmetic fits into a sixteenth of the tolerance. Every length counts:
/// where the scan is, the model at its poses and in its own frame, and the pivot.
/// @param reach as TrajectoryQuery has it. @param far the largest farthestPlace() of the poses
/// @throws InvalidInput
void checkTolerance(const Placed& scan, const TrajectoryRequest& request, const BoxTree& boxes, double reach,
                    double far);

/// Returns the distance within which a record of the model matters to a record of the scan, radii not included: the
/// greatest reach of any pair, at least 0; swept, plus half of the tolerance.
double reachOf(const TrajectoryRequest& request, const Reach& between);

/// Returns the sweep of a request with `swept`. @param reach as TrajectoryQuery has it
PosePath::Sweep sweepOf(const TrajectoryRequest& request, const BoxTree& boxes, double reach);

/// Takes the entries of the first voxel off the front of a list that nearVoxels() returned. @return these entries
std::span<const NearVoxel> takeVoxel(std::span<const NearVoxel>& near_voxels);

/// The result of a voxel's walk.
struct VoxelResult {
  Work work;
  bool undecided = false;           ///< whether points were left undecided
  std::optional<PointPair> witness; ///< where one is wanted
};

/// Takes one voxel of the scan along its intervals. Writes the answers about the voxel's points to the query's result.
/// Different voxels may be walked at the same time.
VoxelResult walkVoxel(const TrajectoryQuery& query, const StopRule& rule, std::span<const NearVoxel> near_voxel);

} // namespace pcl_bsh
