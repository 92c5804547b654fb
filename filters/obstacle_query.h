// SPDX-License-Identifier: BSD-3-Clause
// How close to the obstacle is too close: all of CollisionFilter that knows no point type.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/obstacle_settings.h>
#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <pcl/PCLPointField.h>
#include <pcl/memory.h>
#include <pcl/types.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

class SphereHierarchy;
struct TrajectoryRequest;
struct TrajectoryResult;

/// The settings that CollisionFilter adds to PCL's, and the query they ask. Lengths are in the clouds' own unit.
///
/// Accuracy: no point is called free or colliding that is not, within the tolerance if one
/// was given. What an early stop leaves undecided is never kept as free: it counts as colliding wherever points are
/// kept or removed, and its flag is 2. A time is that of the query alone, after both clouds are sorted into voxels.
/// Filtering throws for what TrajectoryRequest::accuracy says that a trajectory cannot tell.
class ObstacleQuery : public ObstacleSettings {
public:
  /// Greatest distance at which two points collide; touching counts. Finite and >= 0 (default 0), or filtering throws.
  void setClearance(double clearance) { clearance_ = clearance; }
  double getClearance() const { return clearance_; }

  /// As ObstacleSettings has it; the obstacle stands there, and moves no more.
  template <typename Pose>
  void setPose(const Pose& pose)
  {
    ObstacleSettings::setPose(pose);
    trajectory_.reset();
  }

  /// The obstacle moves: its poses in the input's frame, one after another, each rigid as setPose() asks. A point
  /// collides if it does at any of them. At least one pose, or filtering throws. Replaces setPose(), and the other way
  /// round.
  void setTrajectory(const std::vector<Eigen::Isometry3d>& poses) { trajectory_ = poses; }
  const std::optional<std::vector<Eigen::Isometry3d>>& getTrajectory() const { return trajectory_; }

  /// > 0: points collide with the motion between consecutive poses of the trajectory too (straight for the obstacle's
  /// origin, the rotation spherically interpolated), to this tolerance: those within clearance do, those beyond
  /// clearance + tolerance do not. 0 (default): at the poses alone. Finite and >= 0, or filtering throws.
  void setSwept(double tolerance) { swept_ = tolerance; }
  double getSwept() const { return swept_; }

  /// How far the points of the input, or of the obstacle, may truly be from where they were measured. Then a point
  /// collides where it does wherever all points truly are, it is free where it cannot collide, and else it is
  /// undecided: its flag is 2, and it counts as colliding wherever points are kept or removed. Default: not at all.
  /// @throws std::invalid_argument for numbers that are not finite and >= 0. Filtering throws where a field is missing,
  ///   or holds such a number for a finite point.
  void setInputUncertainty(const Uncertainty& uncertainty);
  void setObstacleUncertainty(const Uncertainty& uncertainty) { obstacle_.setUncertainty(uncertainty); }
  const Uncertainty& getInputUncertainty() const { return input_uncertainty_; }
  const Uncertainty& getObstacleUncertainty() const { return obstacle_.uncertainty(); }

  /// How many points of the input the last query left undecided. 0 unless its accuracy let it stop early, or points are
  /// uncertain.
  std::size_t getUndecidedCount() const { return undecided_; }

  /// How many of them because the obstacle is not scanned densely enough.
  std::size_t getSparseCount() const { return sparse_; }

  /// The density guard: a point that is free of all of the obstacle's points, but not of its surface between them, is
  /// undecided with the reason *not scanned densely enough*: its flag is 3, and it counts as colliding wherever points
  /// are kept or removed. FlagsRequest::spacings_of_b says what is promised and what not, patchSpacings() how wide the
  /// holes between the obstacle's points are taken to be. These are measured once for an obstacle. At one pose: along a
  /// trajectory, filtering throws. A surface has no holes, and nothing to guard. Default: false.
  void setDensityGuard(bool density_guard) { density_guard_ = density_guard; }
  bool getDensityGuard() const { return density_guard_; }

  /// What gapes wider in the obstacle is an opening, not a surface. 0 (default): eight times the median distance of its
  /// points from their nearest neighbours. Where lines of a scan are farther apart than that, give more than what is
  /// between the lines. Finite and >= 0, or filtering throws.
  void setWidestGap(double widest_gap) { widest_gap_ = widest_gap; }
  double getWidestGap() const { return widest_gap_; }

protected:
  ObstacleQuery() = default;
  ~ObstacleQuery() = default;
  ObstacleQuery(const ObstacleQuery&) = default;
  ObstacleQuery& operator=(const ObstacleQuery& other); ///< all of it, or std::bad_alloc and nothing has changed
  ObstacleQuery& operator=(ObstacleQuery&&) = default;

  /// One per record of the input: 1 collides, 2 is undecided, 0 is free.
  /// @param surface null, or what the input's records are the balls of; then there is one per triangle instead
  /// @throws std::invalid_argument when a setting is missing or not what its declaration asks for.
  std::vector<std::uint8_t> collisionFlags(const PointsView& input, const SurfaceCover* surface = nullptr);

  /// Everything that is known of each point (of a surface: each triangle) along the trajectory, or at the one pose.
  /// Throws as collisionFlags() does.
  TrajectoryResult alongTrajectory(const PointsView& input, const SurfaceCover* surface = nullptr);

  /// Parts the input's points, in their order, into those that are free (if `negative`: that are not) and the rest.
  /// Points that are not finite are always of the rest. Throws as collisionFlags() does.
  /// @param removed may be null
  void select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed);

  /// @param fields of the view's records
  PointsView asUncertainInput(const PointsView& input, const std::vector<pcl::PCLPointField>& fields) const
  {
    return withUncertainty(input, fields, "input cloud", input_uncertainty_);
  }

private:
  const float* obstacleSpacings();
  TrajectoryResult run(const PointsView& input, const SurfaceCover* surface, TrajectoryRequest& request);

  Uncertainty input_uncertainty_;
  std::optional<std::vector<Eigen::Isometry3d>> trajectory_; ///< instead of pose_
  double swept_ = 0.0;
  double clearance_ = 0.0;
  std::size_t undecided_ = 0;
  std::size_t sparse_ = 0;
  bool density_guard_ = false;
  double widest_gap_ = 0.0;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
