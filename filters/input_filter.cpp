// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/input_filter.h>

#include <cstddef>
#include <stdexcept>

namespace pcl_bsh {

void InputFilter<pcl::PCLPointCloud2>::setInputCloud(const PCLPointCloud2ConstPtr& cloud)
{
  if (!cloud) throw std::invalid_argument("input cloud is null: give an empty cloud if there are no points");
  field_sizes_.reserve(cloud->fields.size()); // PCL's would take the cloud first, then allocate them
  numberPoints(std::size_t{cloud->width} * cloud->height);
  NumberedFilter<pcl::PCLPointCloud2>::setInputCloud(cloud);
}

} // namespace pcl_bsh
