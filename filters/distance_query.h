// SPDX-License-Identifier: BSD-3-Clause
// The other cloud, where it stands and which distances are wanted: all of DistanceFilter that knows no point type.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/kept_obstacle.h>

#include <pcl/memory.h>
#include <pcl/types.h>

#include <Eigen/Geometry>

#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The settings that DistanceFilter adds to PCL's, and the query they ask. Lengths are in the clouds' own unit.
class DistanceQuery {
public:
  /// The cloud that distances lead to: pcl::PointCloud of any point type, or pcl::PCLPointCloud2 (float64 at full
  /// precision). Its hierarchy is built on the first use and kept until the next call of this method; all other
  /// settings and the input may change meanwhile, the cloud's points must not: every use throws when they have
  /// (KeptObstacle). Everything is farther from an empty cloud than any length.
  /// @throws std::invalid_argument when the pointer is null, or as viewOf() does.
  template <typename Cloud>
  void setObstacleCloud(const std::shared_ptr<Cloud>& cloud)
  {
    obstacle_.setCloud(cloud);
  }

  /// The surface that distances lead to, instead of a cloud: the mesh's polygons. Each distance d then means that the
  /// true one is in [d, d + tolerance], up to the rounding of d; limits are compared with d. What a closed surface
  /// encloses is not part of it. The mesh is covered by balls here and now, and not kept.
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

  /// The distances of the points that are kept, both ends inclusive and compared exactly. 0 <= least <= most, and most
  /// may be infinity, or filtering throws. Default: 0 and infinity, all finite points.
  void setFilterLimits(double least, double most) { limits_ = {least, most}; }
  void getFilterLimits(double& least, double& most) const
  {
    least = limits_.first;
    most = limits_.second;
  }

  /// Greater distances are not told but as NaN; which points are kept does not depend on it. >= 0, inclusive, or
  /// filtering throws. Default: infinity, no limit. A small one is faster.
  void setMaxDistance(double max_distance) { max_distance_ = max_distance; }
  double getMaxDistance() const { return max_distance_; }

  /// exact(), floatOnly() or tolerance(): then a distance is that much greater than the true one at most. Default:
  /// exact. Filtering throws for an accuracy that stops early, because points would be left without a distance.
  void setAccuracy(const Accuracy& accuracy) { accuracy_ = accuracy; }
  const Accuracy& getAccuracy() const { return accuracy_; }

  /// Default 1; 0: all of the machine's. The answer is the same for any number.
  void setNumberOfThreads(unsigned threads) { threads_ = threads; }
  unsigned getNumberOfThreads() const { return threads_; }

  /// Called now and then, by the thread that filters, with the fraction done in [0, 1], ascending. False: stop,
  /// filtering throws Cancelled (pcl_bsh/query/cancelled.h). What it throws itself comes out of the filter, too. Either
  /// way outputs stay as they were.
  void setProgress(std::function<bool(double)> progress) { progress_ = std::move(progress); }

  /// What the last query cost.
  const Work& getWork() const { return work_; }

protected:
  DistanceQuery() = default;
  ~DistanceQuery() = default;
  DistanceQuery(const DistanceQuery&) = default;
  DistanceQuery& operator=(const DistanceQuery& other); ///< all of it, or std::bad_alloc and nothing has changed
  DistanceQuery& operator=(DistanceQuery&&) = default;

  /// @throws std::invalid_argument when a setting is missing or not what its declaration asks for
  PointDistances distances(const PointsView& input);

  /// Parts the input's points, in their order, into those within the limits (if `negative`: those that are not) and the
  /// rest. Points that are not finite are always of the rest. Throws as distances() does.
  /// @param removed may be null
  void select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed);

  /// The same, and the distances as floats, one per record: NaN beyond max_distance, where the record is not finite,
  /// and outside the view's subset.
  void select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed,
              std::vector<float>& distances);

private:
  void requireSettings() const;
  PointDistances within(const PointsView& input, double max_distance);
  double reachOfLimits() const;
  void part(const PointsView& input, const PointDistances& found, bool negative, pcl::Indices& kept,
            pcl::Indices* removed) const;

  KeptObstacle obstacle_;
  std::function<bool(double)> progress_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  std::pair<double, double> limits_ = {0.0, std::numeric_limits<double>::infinity()};
  double max_distance_ = std::numeric_limits<double>::infinity();
  Accuracy accuracy_;
  unsigned threads_ = 1;
  Work work_;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
