// SPDX-License-Identifier: BSD-3-Clause
// What the queries of CollisionFilter and DistanceFilter have in common: the other cloud, where it stands, how sure the
// answer has to be, and who computes it.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/kept_obstacle.h>
#include <pcl_bsh/query/accuracy.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/question/warnings.h>

#include <pcl/PolygonMesh.h>

#include <Eigen/Geometry>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The settings of the other cloud; those of a kind of question are in the classes that derive. Lengths are in the
/// clouds' own unit.
class ObstacleSettings {
public:
  /// The cloud that the input is compared with: pcl::PointCloud of any point type, or pcl::PCLPointCloud2 (float64 at
  /// full precision). Its hierarchy is built on the first use and kept until the next call of this method; all other
  /// settings and the input may change meanwhile, the cloud's points must not: every use throws when they have
  /// (KeptObstacle). An empty cloud collides with nothing, and everything is farther from it than any length.
  /// @throws std::invalid_argument when the pointer is null, or as viewOf() does.
  template <typename Cloud>
  void setObstacleCloud(const std::shared_ptr<Cloud>& cloud)
  {
    obstacle_.setCloud(cloud);
  }

  /// A surface instead of a cloud: the mesh's polygons. Then free is farther than the clearance from the surface, for
  /// certain, and colliding is within clearance + tolerance (a tolerance for motion comes on top); a distance d means
  /// that the true one is in [d, d + tolerance], up to the rounding of d, and limits are compared with d. What a closed
  /// surface encloses is not part of it. The mesh is covered by balls here and now, and not kept.
  /// @param tolerance by how much balls may reach beyond the surface, in the clouds' unit; finite and > 0
  /// @throws std::invalid_argument as coverOf() does
  void setObstacleSurface(const pcl::PolygonMesh::ConstPtr& mesh, double tolerance)
  {
    setObstacleSurface(coverOf(mesh, tolerance));
  }

  /// The same, of a surface that is covered already: of coverSurface().
  /// @throws std::invalid_argument when the pointer is null
  void setObstacleSurface(const std::shared_ptr<const SurfaceCover>& cover) { obstacle_.setSurface(cover); }

  /// Null where the obstacle is a cloud. Its records are those that results name: `triangles` of each says which
  /// triangle it stands for.
  const std::shared_ptr<const SurfaceCover>& getObstacleSurface() const { return obstacle_.surface(); }

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
  }
  const Eigen::Isometry3d& getPose() const { return pose_; }

  /// How sure the answer has to be: less is faster. Default: exact. What a query does with one that stops early is said
  /// where the query is declared. Its number is finite and >= 0, or filtering throws.
  void setAccuracy(const Accuracy& accuracy) { accuracy_ = accuracy; }
  const Accuracy& getAccuracy() const { return accuracy_; }

  /// Default 1; 0: all of the machine's. The answer is the same for any number.
  void setNumberOfThreads(unsigned threads) { threads_ = threads; }
  unsigned getNumberOfThreads() const { return threads_; }

  /// For distances, and along a trajectory: called now and then, by the thread that filters, with the fraction done in
  /// [0, 1], ascending. False: stop, filtering throws Cancelled (pcl_bsh/query/cancelled.h). What it throws itself
  /// comes out of the filter, too. Either way outputs stay as they were.
  void setProgress(std::function<bool(double)> progress) { progress_ = std::move(progress); }

  /// Called with each sentence that users should know beside the answer (pcl_bsh/question/warnings.h), of each kind
  /// once in the filter's life, since clouds come in streams. How far points are apart is measured at the first query
  /// alone. Default: PCL_WARN.
  void setWarn(std::function<void(const std::string&)> warn) { warn_ = std::move(warn); }

  /// What the last query cost.
  const Work& getWork() const { return work_; }

protected:
  ObstacleSettings() = default;
  ~ObstacleSettings() = default;
  ObstacleSettings(const ObstacleSettings&) = default;
  ObstacleSettings& operator=(const ObstacleSettings&) = default;
  ObstacleSettings(ObstacleSettings&&) = default;
  ObstacleSettings& operator=(ObstacleSettings&&) = default;

  /// Of the points that are asked about.
  SphereHierarchy hierarchyOf(const PointsView& input) const;

  /// Tells what is new, after a query. @param surface null, or what the input's records are the balls of
  /// @param poses of the obstacle. @param clearance none: distances were asked for
  void warnOf(const SphereHierarchy& input, const SurfaceCover* surface, const SphereHierarchy& obstacle,
              std::vector<Eigen::Isometry3d> poses, std::optional<double> clearance);

  KeptObstacle obstacle_;
  std::function<bool(double)> progress_;
  std::function<void(const std::string&)> warn_; ///< empty: PCL_WARN
  WarningsOnce warnings_;
  bool measured_ = false; ///< spacings
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  Accuracy accuracy_;
  unsigned threads_ = 1;
  Work work_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
