// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/records.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::io {

void addPadding(pcl::PCLPointCloud2& cloud, std::uint64_t bytes)
{
  constexpr std::uint64_t limit = std::numeric_limits<std::uint32_t>::max();
  if (bytes > limit - cloud.point_step) throw FormatError("a point takes more than 4 GiB");
  cloud.point_step += static_cast<std::uint32_t>(bytes);
}

void addField(pcl::PCLPointCloud2& cloud, const std::string& name, std::uint8_t datatype, std::uint64_t count)
{
  pcl::PCLPointField field;
  field.name = name;
  field.offset = cloud.point_step;
  field.datatype = datatype;
  field.count = static_cast<std::uint32_t>(count);
  constexpr std::uint64_t limit = std::numeric_limits<std::uint32_t>::max();
  addPadding(cloud, std::min(count, limit) * sizeOf(datatype));
  cloud.fields.push_back(std::move(field));
}

void requirePoints(std::uint64_t points)
{
  if (points <= max_points) return;
  throw FormatError("it has " + counted(points, "point") + ", more than the " + std::to_string(max_points) +
                        " that an index can name",
                    "split the cloud");
}

void requireBytes(std::uint64_t points, std::uint64_t least_bytes, std::uint64_t bytes_left)
{
  requirePoints(points);
  if (points == 0 || points <= bytes_left / least_bytes) return;
  throw FormatError("is truncated: its header promises " + counted(points, "point") + ", its size allows " +
                    std::to_string(bytes_left / least_bytes) + " at most");
}

namespace {

void setSize(pcl::PCLPointCloud2& cloud, std::uint32_t width, std::uint32_t height)
{
  cloud.width = width;
  cloud.height = height;
  cloud.row_step = width * cloud.point_step;
}

} // namespace

void allocate(pcl::PCLPointCloud2& cloud, std::uint32_t width, std::uint32_t height)
{
  setSize(cloud, width, height);
  cloud.data.assign(std::size_t{width} * height * cloud.point_step, 0);
}

void resizeRecords(pcl::PCLPointCloud2& cloud, std::uint32_t width)
{
  setSize(cloud, width, 1);
  const std::size_t bytes = std::size_t{width} * cloud.point_step;
  if (bytes > cloud.data.capacity()) cloud.data = {}; // nothing to be copied
  cloud.data.resize(bytes);
}

void setDense(pcl::PCLPointCloud2& cloud)
{
  cloud.is_dense = true;
  const std::uint8_t* const end = cloud.data.data() + cloud.data.size();
  for (const pcl::PCLPointField& field : cloud.fields) {
    withFieldType(field.datatype, [&](auto value) {
      if constexpr (std::is_floating_point_v<decltype(value)>) {
        for (const std::uint8_t* record = cloud.data.data(); record != end && cloud.is_dense;
             record += cloud.point_step) {
          for (std::uint32_t i = 0; i < field.count; ++i) {
            std::memcpy(&value, record + field.offset + i * sizeof value, sizeof value);
            if (!std::isfinite(value)) cloud.is_dense = false;
          }
        }
      }
    });
  }
}

std::vector<pcl::PCLPointField> namedFields(const pcl::PCLPointCloud2& cloud)
{
  std::vector<pcl::PCLPointField> fields;
  for (pcl::PCLPointField field : cloud.fields) {
    if (field.name == "_") continue;
    if (field.name.empty() || field.name.find_first_of(" \t\r\n") != std::string::npos) {
      throw FormatError("a field named '" + field.name + "' cannot be written", "rename the field");
    }
    field.count = std::max(field.count, 1U);
    if (field.offset + sizeOf(field) > cloud.point_step) {
      throw FormatError("field '" + field.name + "' lies outside the records", "build the cloud anew");
    }
    fields.push_back(std::move(field));
  }
  if (fields.empty()) throw FormatError("the cloud has no fields", "write a cloud with x y z");
  if (cloud.data.size() / std::max(cloud.point_step, 1U) < std::uint64_t{cloud.width} * cloud.height) {
    throw FormatError("the cloud has fewer records than width x height", "build the cloud anew");
  }
  return fields;
}

void forEachPackedBlock(const pcl::PCLPointCloud2& cloud, const std::vector<pcl::PCLPointField>& fields, Lists lists,
                        const std::function<void(std::string_view)>& use)
{
  constexpr std::size_t block_bytes = std::size_t{1} << 20;
  const std::size_t records = std::size_t{cloud.width} * cloud.height;
  std::string block;
  for (std::size_t i = 0; i < records; ++i) {
    const auto* record = reinterpret_cast<const char*>(cloud.data.data()) + i * cloud.point_step;
    for (const pcl::PCLPointField& field : fields) {
      if (lists == Lists::counted && field.count > 1) {
        block.append(reinterpret_cast<const char*>(&field.count), sizeof(std::uint32_t));
      }
      block.append(record + field.offset, sizeOf(field));
    }
    if (block.size() >= block_bytes || i + 1 == records) {
      use(block);
      block.clear();
    }
  }
}

} // namespace pcl_bsh::io
