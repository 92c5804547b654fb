// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/collision_field.h>

#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using Field = pcl::PCLPointField;

void requireByteField(const Field& field, const pcl::PCLPointCloud2& cloud)
{
  if (field.datatype != Field::UINT8 || field.count > 1 || field.offset >= cloud.point_step) {
    throw std::invalid_argument("field '" + field.name +
                                "' exists already and is not one UINT8 per point: rename or remove it");
  }
}

/// The cloud with room for one more byte at the end of each record. Records are packed, not aligned: padding would
/// show as fields named "_" in every file PCL writes.
pcl::PCLPointCloud2 widened(const pcl::PCLPointCloud2& cloud, std::size_t points)
{
  pcl::PCLPointCloud2 result;
  result.header = cloud.header;
  result.height = cloud.height;
  result.width = cloud.width;
  result.fields = cloud.fields;
  result.is_bigendian = cloud.is_bigendian;
  result.is_dense = cloud.is_dense;
  result.point_step = cloud.point_step + 1;
  result.row_step = result.point_step * result.width;
  result.data.resize(points * result.point_step);
  for (std::size_t i = 0; i < points; ++i) {
    std::memcpy(&result.data[i * result.point_step], &cloud.data[i * cloud.point_step], cloud.point_step);
  }
  return result;
}

} // namespace

pcl::PCLPointCloud2 withField(const pcl::PCLPointCloud2& cloud, const std::string& name,
                              const std::vector<std::uint8_t>& values)
{
  const std::size_t points = viewOf(cloud).count;
  if (values.size() != points) {
    throw std::invalid_argument("field '" + name + "' has " + std::to_string(values.size()) +
                                " values: the cloud has " + std::to_string(points) + " points");
  }

  pcl::PCLPointCloud2 result;
  auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(), [&](const Field& f) { return f.name == name; });
  std::size_t offset = cloud.point_step;
  if (field != cloud.fields.end()) {
    requireByteField(*field, cloud);
    offset = field->offset;
    result = cloud;
  }
  else {
    result = widened(cloud, points);
    Field added;
    added.name = name;
    added.offset = cloud.point_step;
    added.datatype = Field::UINT8;
    added.count = 1;
    result.fields.push_back(added);
  }
  for (std::size_t i = 0; i < points; ++i) result.data[i * result.point_step + offset] = values[i];
  return result;
}

} // namespace pcl_bsh
