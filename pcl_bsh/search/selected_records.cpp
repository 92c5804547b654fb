// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/search/selected_records.h>

#include <cstdint>
#include <cstring>

namespace pcl_bsh {

pcl::PCLPointCloud2 withoutRecords(const pcl::PCLPointCloud2& cloud)
{
  pcl::PCLPointCloud2 empty;
  empty.header = cloud.header;
  empty.height = 1;
  empty.fields = cloud.fields;
  empty.is_bigendian = cloud.is_bigendian;
  empty.is_dense = cloud.is_dense;
  empty.point_step = cloud.point_step;
  return empty;
}

pcl::PCLPointCloud2 selectedRecords(const pcl::PCLPointCloud2& cloud, const pcl::Indices& records)
{
  pcl::PCLPointCloud2 selected = withoutRecords(cloud);
  const std::size_t step = cloud.point_step;
  selected.width = static_cast<std::uint32_t>(records.size());
  selected.row_step = selected.width * selected.point_step;
  selected.data.resize(records.size() * step);
  std::uint8_t* next = selected.data.data();
  for (const pcl::index_t i : records) {
    std::memcpy(next, &cloud.data[static_cast<std::size_t>(i) * step], step);
    next += step;
  }
  return selected;
}

} // namespace pcl_bsh
