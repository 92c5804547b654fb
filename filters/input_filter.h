// SPDX-License-Identifier: BSD-3-Clause
// PCL's base of filters, with an input that is never half taken.
#pragma once

#include <pcl_bsh/export.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/filters/filter_indices.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// PCL's base of filters, as it is.
template <typename PointT>
class InputFilter : public pcl::FilterIndices<PointT> {
public:
  using pcl::FilterIndices<PointT>::FilterIndices;
};

/// The same for clouds whose fields are known at run time only, with an input of its own.
template <>
class PCL_BSH_EXPORT InputFilter<pcl::PCLPointCloud2> : public pcl::FilterIndices<pcl::PCLPointCloud2> {
public:
  using pcl::FilterIndices<pcl::PCLPointCloud2>::FilterIndices;

  /// @throws std::invalid_argument when the pointer is null, as PCL's own would crash. On an error the former input
  ///   stays.
  void setInputCloud(const PCLPointCloud2ConstPtr& cloud);
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
