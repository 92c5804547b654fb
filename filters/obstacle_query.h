// SPDX-License-Identifier: BSD-3-Clause
// The obstacle, where it stands and how close is too close: all of CollisionFilter that knows no point type.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/kept_obstacle.h>
#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/common/io.h>
#include <pcl/memory.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

class SphereHierarchy;
struct TrajectoryRequest;
struct TrajectoryResult;

/// The settings that CollisionFilter adds to PCL's, and the query they ask. Lengths are in the clouds' own unit.
class ObstacleQuery {
public:
  /// The cloud to collide with: pcl::PointCloud of any point type, or pcl::PCLPointCloud2 (float64 at full precision).
  /// Its hierarchy is built on the first use and kept until the next call of this method; pose, clearance and input may
  /// change meanwhile, the cloud's points must not: every use compares a checksum of their coordinates and throws when
  /// they have. That takes some 20 instructions a point, a tenth or less of what building takes. An empty cloud
  /// collides with nothing.
  /// @throws std::invalid_argument when the pointer is null, or as viewOf() does.
  template <typename Cloud>
  void setObstacleCloud(const std::shared_ptr<Cloud>& cloud)
  {
    obstacle_.setCloud(cloud);
    spacings_.reset();
  }

  /// The surface to collide with, instead of a cloud: the mesh's polygons. Then free is farther than the clearance from
  /// the surface, for certain, and colliding is within clearance + tolerance (with setSwept(), its tolerance comes on
  /// top); a distance d means that the true one is in [d, d + tolerance]. What a closed surface encloses is not part of
  /// it. The mesh is covered by balls here and now, and not kept.
  /// @param tolerance by how much balls may reach beyond the surface, in the clouds' unit; finite and > 0
  /// @throws std::invalid_argument as coverOf() does
  void setObstacleSurface(const pcl::PolygonMesh::ConstPtr& mesh, double tolerance)
  {
    setObstacleSurface(coverOf(mesh, tolerance));
  }

  /// The same, of a surface that is covered already: of coverSurface().
  /// @throws std::invalid_argument when the pointer is null
  void setObstacleSurface(const std::shared_ptr<const SurfaceCover>& cover)
  {
    obstacle_.setSurface(cover);
    spacings_.reset();
  }

  /// Null where the obstacle is a cloud. Its records are those that results name: `triangles` of each says which
  /// triangle it stands for.
  const std::shared_ptr<const SurfaceCover>& getObstacleSurface() const { return obstacle_.surface(); }

  /// Greatest distance at which two points collide; touching counts. Finite and >= 0 (default 0), or filtering throws.
  void setClearance(double clearance) { clearance_ = clearance; }
  double getClearance() const { return clearance_; }

  /// Pose of the obstacle in the input's frame, T_input_obstacle. Rigid within 1e-6 (default: identity), or filtering
  /// throws. Takes any of Eigen's transforms, and 4x4 matrices as PCL's registration returns them; float or double.
  template <typename Scalar, int Mode, int Options>
  void setPose(const Eigen::Transform<Scalar, 3, Mode, Options>& pose)
  {
    setPose(pose.matrix());
  }
  template <typename Derived>
  void setPose(const Eigen::MatrixBase<Derived>& pose)
  {
    pose_.matrix() = pose.template cast<double>();
    trajectory_.reset();
  }
  const Eigen::Isometry3d& getPose() const { return pose_; }

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

  /// How sure the answer has to be: less is faster. Default: exact. Unless it is floatOnly(), no point is called free
  /// or colliding that is not, within the tolerance if one was given. What an early stop leaves undecided is never kept
  /// as free: it counts as colliding wherever points are kept or removed, and its flag is 2. A time is that of the
  /// query alone, after both clouds are sorted into voxels. Its number is finite and >= 0, or filtering throws; so it
  /// does for what TrajectoryRequest::accuracy says that a trajectory cannot tell.
  void setAccuracy(const Accuracy& accuracy) { accuracy_ = accuracy; }
  const Accuracy& getAccuracy() const { return accuracy_; }

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
  void setWidestGap(double widest_gap);
  double getWidestGap() const { return widest_gap_; }

  /// Default 1; 0: all of the machine's. The answer is the same for any number.
  void setNumberOfThreads(unsigned threads) { threads_ = threads; }
  unsigned getNumberOfThreads() const { return threads_; }

  /// Along a trajectory: called now and then, by the thread that filters, with the fraction done in [0, 1], ascending.
  /// False: stop, filtering throws Cancelled (pcl_bsh/query/cancelled.h). What it throws itself comes out of the
  /// filter, too. Either way outputs stay as they were.
  void setProgress(std::function<bool(double)> progress) { progress_ = std::move(progress); }

  /// What the last query cost.
  const Work& getWork() const { return work_; }

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
  void warnOfCoarse(const char* cloud, const SphereHierarchy& hierarchy);
  const float* obstacleSpacings(const SphereHierarchy& obstacle);
  TrajectoryResult run(const PointsView& input, const SurfaceCover* surface, TrajectoryRequest& request);

  KeptObstacle obstacle_;
  Uncertainty input_uncertainty_;
  std::function<bool(double)> progress_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  std::optional<std::vector<Eigen::Isometry3d>> trajectory_; ///< instead of pose_
  double swept_ = 0.0;
  double clearance_ = 0.0;
  Accuracy accuracy_;
  unsigned threads_ = 1;
  Work work_;
  std::size_t undecided_ = 0;
  std::size_t sparse_ = 0;
  bool density_guard_ = false;
  double widest_gap_ = 0.0;
  std::shared_ptr<const std::vector<float>> spacings_; ///< of the hierarchy's records, once they are asked for
  bool warned_ = false; ///< of coordinates too coarse for the clearance; once, for clouds come in streams

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
