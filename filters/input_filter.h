// SPDX-License-Identifier: BSD-3-Clause
// PCL's base of filters. When memory runs out in setInputCloud(), the former input stays.
#pragma once

#include <pcl_bsh/export.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/filters/filter_indices.h>
#include <pcl/point_cloud.h>

#include <cstddef>
#include <memory>
#include <numeric>
#include <utility>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// PCL numbers all points of the input in filter(), where the user has set no indices. When memory runs out there, PCL
/// 1.15 prints a line and filters nothing. So this class makes the numbers before.
template <typename PointT>
class NumberedFilter : public pcl::FilterIndices<PointT> {
public:
  using pcl::FilterIndices<PointT>::FilterIndices;

protected:
  /// Where memory runs out, the former numbers stay.
  void numberPoints(std::size_t count)
  {
    if (this->indices_ && (!this->fake_indices_ || this->indices_->size() == count)) return;
    auto all = std::make_shared<pcl::Indices>(count);
    std::iota(all->begin(), all->end(), 0);
    this->indices_ = std::move(all);
    this->fake_indices_ = true;
  }
};

/// @throws std::bad_alloc from setInputCloud(); then the former input stays
template <typename PointT>
class InputFilter : public NumberedFilter<PointT> {
public:
  using NumberedFilter<PointT>::NumberedFilter;

  /// Numbers all points of the cloud, too, before PCL does.
  void setInputCloud(const typename pcl::PointCloud<PointT>::ConstPtr& cloud) override
  {
    if (cloud) this->numberPoints(cloud->size());
    NumberedFilter<PointT>::setInputCloud(cloud);
  }
};

/// As InputFilter of a point type, for clouds whose fields are known at run time only.
template <>
class PCL_BSH_EXPORT InputFilter<pcl::PCLPointCloud2> : public NumberedFilter<pcl::PCLPointCloud2> {
public:
  using NumberedFilter<pcl::PCLPointCloud2>::NumberedFilter;

  /// @throws std::invalid_argument when the pointer is null, as PCL's own would crash. On an error the former input
  ///   stays.
  void setInputCloud(const PCLPointCloud2ConstPtr& cloud);
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
