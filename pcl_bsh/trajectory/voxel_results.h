// SPDX-License-Identifier: BSD-3-Clause
// The answers so far about the points of one of the scan's voxels, and about the poses at which it was looked at.
#pragma once

#include <pcl_bsh/trajectory/query.h>

#include <vector>

namespace pcl_bsh {

/// The nearest point of the model, so far.
struct NearestPoint {
  double time = 0.0; ///< pose of the path; swept: plus the fraction of the motion to the next
  double gap = std::numeric_limits<double>::infinity(); ///< swept: the distance; else no less, and infinite for points
  bool meets = false; ///< whether the distance is 0 (swept: up to rounding), so that nothing is nearer
  std::uint32_t record = kNothing;
  float limit = std::numeric_limits<float>::infinity(); ///< a pair at a larger squared distance is not nearer
  float reach = std::numeric_limits<float>::infinity(); ///< a pair at a larger distance is not nearer
};

/// Leaves of the voxel are named by slots: 8 * the node + the child. Points by their place in the voxel, poses by their
/// place on the path.
class VoxelResults {
public:
  explicit VoxelResults(const TrajectoryQuery& query) : query_(query) {}

  /// Allocates the results of the points of a voxel that is built.
  void begin(const Voxel& voxel);

  /// Allocates the results of poses first..last of the path.
  void beginPoses(std::uint32_t first, std::uint32_t last);

  /// Writes to the query's result.
  void finish(const Voxel& voxel);

  /// Where flags start as undecided: writes those of the voxel that are decided now.
  /// @param unsure whether only hits are decided. @return whether points were left undecided.
  bool decide(const Voxel& voxel, bool unsure);

  std::vector<std::uint16_t> hit, settled; ///< per slot: bits of the leaf's points
  std::vector<std::uint16_t> undecided; ///< per slot: such bits; for a child that is no leaf, any bit means all points
  std::vector<double> first;            ///< per point: when it collides first, if that is asked for; see firstOf()
  double earliest = std::numeric_limits<double>::infinity(); ///< swept: the least of `first`
  std::vector<NearestPoint> best;                            ///< per point, if that is asked for
  std::optional<PointPair> witness;                          ///< where one is wanted
  Work work;

  /// Whether the pair collides at a pose, in exact arithmetic.
  bool collide(PointPair pair, std::uint32_t k);

  /// Whether the distance of a pair is 0 at a pose.
  bool meet(PointPair pair, std::uint32_t k);

  /// Keeps the nearest for a point; of several the first pose, and there the smallest record.
  void consider(NearestPoint& nearest, PointPair pair, std::uint32_t k);

  /// Keeps the nearest where the order is known. @param order sign of the pair's gap less that of the nearest
  static void take(NearestPoint& nearest, PointPair pair, std::uint32_t k, int order)
  {
    const auto best_pose = static_cast<std::uint32_t>(nearest.time);
    if (order > 0 || (order == 0 && (k > best_pose || (k == best_pose && pair.b >= nearest.record)))) return;
    nearest.time = k;
    nearest.record = pair.b;
  }

  /// Returns the time, for a point that collides, after which contacts change no answer. Where the first contact of
  /// each point of a swept motion is not asked for, the first of all points is enough, and `first` of a point is any of
  /// its contacts.
  double firstOf(std::uint32_t point) const
  {
    return query_.path.is_swept && !query_.request.first_poses ? earliest : first[point];
  }

  /// Whether the best so far bounds the search for a point of the voxel from this pose on.
  bool bestBounds(std::uint32_t point, double from) const
  {
    return query_.bestBounds(query_.first ? firstOf(point) : 0.0, from);
  }

  /// Keeps the nearest for a pose.
  void considerPose(PointPair pair, std::uint32_t k);

  /// A larger squared distance, in floats, is not the smallest at the pose.
  float poseLimit(std::uint32_t k) const { return pose_bounds_[k - first_pose_].limit; }
  /// A larger distance is not the smallest at the pose.
  float poseReach(std::uint32_t k) const { return pose_bounds_[k - first_pose_].reach; }
  void lowerPoseLimit(std::uint32_t k, float limit, float reach);

  void countPose(std::uint32_t k, std::size_t points) { pose_counts_[k - first_pose_] += points; }

private:
  /// Bounds the smallest distance at a pose: a squared distance in floats, and a distance.
  struct PoseBound {
    float limit = std::numeric_limits<float>::infinity();
    float reach = std::numeric_limits<float>::infinity();
  };

  RecordDistance exactAt(std::uint32_t k) const;
  std::int32_t givenPose(double time) const;
  float distanceOf(std::uint32_t record, const NearestPoint& nearest) const;
  void mergePoses() const; // with the query locked

  const TrajectoryQuery& query_;
  std::uint32_t first_pose_ = 0;
  std::vector<NearestAtPose> nearest_at_pose_;
  std::vector<PoseBound> pose_bounds_;
  std::vector<std::size_t> pose_counts_;
  std::vector<Verdict> verdicts_; // per point
};

} // namespace pcl_bsh
