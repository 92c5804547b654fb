// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/impl/distance_filter.hpp>

#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/removed_points.h>
#include <pcl_bsh/search/selected_records.h>

#include <pcl/impl/instantiate.hpp>
#include <pcl/point_types.h>

namespace pcl_bsh {

void DistanceFilter<pcl::PCLPointCloud2>::applyFilter(pcl::PCLPointCloud2& output)
{
  pcl::Indices kept;
  std::vector<float> distances;
  select(passing(inputShape(), &distances), kept, removed_indices_.get());
  output = withFields(*input_, {{distance_field_name, &distances}});
  if (keep_organized_)
    overwritePoints(output, *removed_indices_, user_filter_value_);
  else
    output = selectedRecords(output, kept);
}

} // namespace pcl_bsh

template class pcl_bsh::QueryFilter<pcl::PCLPointCloud2, pcl_bsh::DistanceSettings>;
template class pcl_bsh::DistanceFilterBase<pcl::PCLPointCloud2>;
PCL_INSTANTIATE(DistanceFilter, PCL_XYZ_POINT_TYPES)
