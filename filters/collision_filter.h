// SPDX-License-Identifier: BSD-3-Clause
// A PCL filter that removes the points of a cloud that collide with an obstacle cloud, keeps only those, or flags them.
//
//   pcl_bsh::CollisionFilter<pcl::PointXYZ> filter;
//   filter.setObstacleCloud(robot);      // of any point type
//   filter.setPose(T_scan_robot);        // the robot in the scan's frame
//   filter.setClearance(0.05);           // in the clouds' unit; touching counts
//   filter.setInputCloud(scan);
//   filter.filter(free);                 // the scan without what touches the robot
//
// Free is never the answer to a failure: where PCL's filters would print a line and return, this one throws.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/query_filter.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The part that the typed filter and the one of pcl::PCLPointCloud2 share. Use CollisionFilter.
///
/// filter() keeps the points of the input that do not collide; after setNegative(true), those that do, with those that
/// are undecided (setAccuracy()). If filter() is called through a pointer to pcl::Filter, setKeepFlagged() needs an
/// output that is not the input. From PCL 1.15 on, the output may then be left alone when memory runs out: QueryFilter
/// says where.
template <typename PointT>
class CollisionFilterBase : public QueryFilter<PointT, CollisionSettings> {
public:
  /// @param extract_removed_indices keep what getRemovedIndices() returns
  explicit CollisionFilterBase(bool extract_removed_indices = false);

  /// Gives one verdict per point of the whole input cloud, also after setNegative(true). Undecided needs setAccuracy()
  /// or uncertain points, sparse needs setDensityGuard(). Points outside setIndices() and points that are not finite
  /// are free. Throws as filter() does.
  void computeFlags(std::vector<Verdict>& flags);

  /// Gives more than flags along the trajectory (or at the one pose). Each colliding point of the whole input cloud has
  /// its smallest distance, the first pose and the closest. Each pose has a summary, unless swept. Throws as filter()
  /// does.
  void computeTrajectory(TrajectoryResult& result);

  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

/// Removes from a pcl::PointCloud<PointT> what collides with the obstacle.
///
/// Instantiated for PCL's XYZ types. For a point type of your own define PCL_NO_PRECOMPILE before the first PCL header.
template <typename PointT>
class CollisionFilter : public CollisionFilterBase<PointT> {
public:
  using Ptr = std::shared_ptr<CollisionFilter<PointT>>;
  using ConstPtr = std::shared_ptr<const CollisionFilter<PointT>>;

  using CollisionFilterBase<PointT>::CollisionFilterBase;
  using CollisionFilterBase<PointT>::setIndices;

  /// As PCL's, for a rectangle of the input. Where memory runs out, the former indices stay; PCL's would go on with
  /// none.
  void setIndices(std::size_t row_start, std::size_t col_start, std::size_t nb_rows, std::size_t nb_cols) override;
};

extern template class PCL_BSH_EXPORT
    QueryFilter<pcl::PCLPointCloud2, CollisionSettings>;                       // PCL's hidden type would hide
extern template class PCL_BSH_EXPORT CollisionFilterBase<pcl::PCLPointCloud2>; // both

/// The filter for clouds whose fields are known at run time only. Keeps every field; reads float64 coordinates at full
/// precision; can flag the points instead of removing any.
template <>
class PCL_BSH_EXPORT CollisionFilter<pcl::PCLPointCloud2> : public CollisionFilterBase<pcl::PCLPointCloud2> {
public:
  using Ptr = std::shared_ptr<CollisionFilter<pcl::PCLPointCloud2>>;
  using ConstPtr = std::shared_ptr<const CollisionFilter<pcl::PCLPointCloud2>>;

  using CollisionFilterBase<pcl::PCLPointCloud2>::CollisionFilterBase;

  /// true: filter(cloud) removes nothing and adds a field `collision` (UINT8), the flags of computeFlags(), whatever
  /// setNegative() and setKeepOrganized() say; along a trajectory also `distance` (FLOAT32, NaN where free),
  /// `first_pose` and `closest_pose` (INT32, -1 where free). Default: false.
  void setKeepFlagged(bool keep_flagged) { keep_flagged_ = keep_flagged; }
  bool getKeepFlagged() const { return keep_flagged_; }

protected:
  using CollisionFilterBase<pcl::PCLPointCloud2>::applyFilter;
  void applyFilter(pcl::PCLPointCloud2& output) override;

private:
  bool keep_flagged_ = false;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

#ifdef PCL_NO_PRECOMPILE
#include <pcl_bsh/filters/impl/collision_filter.hpp>
#endif
