// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/added_fields.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/search/find_field.h>

#include <cstring>
#include <stdexcept>

namespace pcl_bsh::pipeline {
namespace {

/// Makes each record longer, in place: from the last to the first, none is overwritten before it has moved.
void widenRecords(pcl::PCLPointCloud2& cloud, std::size_t old_step)
{
  const std::size_t points = std::size_t{cloud.width} * cloud.height;
  cloud.data.resize(points * cloud.point_step);
  for (std::size_t i = points; i-- > 1;) {
    std::memmove(&cloud.data[i * cloud.point_step], &cloud.data[i * old_step], old_step);
  }
  cloud.row_step = cloud.width * cloud.point_step;
}

} // namespace

std::vector<std::size_t> addFields(pcl::PCLPointCloud2& cloud, const std::vector<std::string>& names,
                                   std::uint8_t datatype)
{
  const std::size_t old_step = cloud.point_step;
  std::vector<std::size_t> offsets;
  for (const std::string& name : names) {
    const pcl::PCLPointField* field = findField(cloud, name);
    if (field == nullptr) {
      io::addField(cloud, name, datatype);
      field = &cloud.fields.back();
    }
    else if (field->datatype != datatype || field->count > 1) {
      throw std::invalid_argument("the cloud has a field '" + name + "' of another type: rename it");
    }
    offsets.push_back(field->offset);
  }
  if (cloud.point_step != old_step && !cloud.data.empty()) widenRecords(cloud, old_step);
  return offsets;
}

} // namespace pcl_bsh::pipeline
