// SPDX-License-Identifier: BSD-3-Clause
// A PCL filter that keeps the points of a cloud whose distance to another cloud is within limits.
//
//   pcl_bsh::DistanceFilter<pcl::PointXYZ> filter;
//   filter.setObstacleCloud(before);         // of any point type
//   filter.setPose(T_after_before);          // that cloud in the input's frame
//   filter.setFilterLimits(0.1, infinity);   // in the clouds' unit; both inclusive
//   filter.setInputCloud(after);
//   filter.filter(appeared);                 // what has no counterpart nearer than 10 cm
//
// A distance is that to the nearest point, exact. Where PCL's filters would print a line and return, this one throws.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/query_filter.h>

#include <cstddef>
#include <memory>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The base of the typed filter and of the one of pcl::PCLPointCloud2. Use DistanceFilter. Called through a pointer to
/// pcl::Filter, from PCL 1.15 on filter() may leave the output alone when memory runs out: QueryFilter says where.
template <typename PointT>
class DistanceFilterBase : public QueryFilter<PointT, DistanceSettings> {
public:
  /// @param extract_removed_indices keep what getRemovedIndices() returns
  explicit DistanceFilterBase(bool extract_removed_indices = false);

  /// The distance of each point of the whole input cloud, whatever the limits, up to setMaxDistance(); none for points
  /// outside setIndices() and for points that are not finite. Throws as filter() does.
  void computeDistances(PointDistances& result);

  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

/// Keeps of a pcl::PointCloud<PointT> what is within setFilterLimits().
///
/// Instantiated for PCL's XYZ types. For a point type of your own define PCL_NO_PRECOMPILE before the first PCL header.
template <typename PointT>
class DistanceFilter : public DistanceFilterBase<PointT> {
public:
  using Ptr = std::shared_ptr<DistanceFilter<PointT>>;
  using ConstPtr = std::shared_ptr<const DistanceFilter<PointT>>;

  using DistanceFilterBase<PointT>::DistanceFilterBase;
  using DistanceFilterBase<PointT>::setIndices;

  /// As PCL's, for a rectangle of the input. Where memory runs out, the former indices stay; PCL's would go on with
  /// none.
  void setIndices(std::size_t row_start, std::size_t col_start, std::size_t nb_rows, std::size_t nb_cols) override;
};

extern template class PCL_BSH_EXPORT QueryFilter<pcl::PCLPointCloud2, DistanceSettings>; // PCL's hidden type would hide
extern template class PCL_BSH_EXPORT DistanceFilterBase<pcl::PCLPointCloud2>;            // both

/// The filter for clouds whose fields are known at run time only. Keeps every field, and adds one: `distance` (FLOAT32,
/// NaN beyond setMaxDistance() and for points that are not finite or outside setIndices()); a FLOAT32 field of that
/// name takes the new values. Reads float64 coordinates at full precision. In a cloud that keeps rows and columns,
/// removed points have their distance, too.
template <>
class PCL_BSH_EXPORT DistanceFilter<pcl::PCLPointCloud2> : public DistanceFilterBase<pcl::PCLPointCloud2> {
public:
  using Ptr = std::shared_ptr<DistanceFilter<pcl::PCLPointCloud2>>;
  using ConstPtr = std::shared_ptr<const DistanceFilter<pcl::PCLPointCloud2>>;

  using DistanceFilterBase<pcl::PCLPointCloud2>::DistanceFilterBase;

protected:
  using DistanceFilterBase<pcl::PCLPointCloud2>::applyFilter;
  void applyFilter(pcl::PCLPointCloud2& output) override;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

#ifdef PCL_NO_PRECOMPILE
#include <pcl_bsh/filters/impl/distance_filter.hpp>
#endif
