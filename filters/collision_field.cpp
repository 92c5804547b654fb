// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/search/selected_records.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/search/find_field.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <pcl/common/io.h>
#include <pcl/type_traits.h>

#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace pcl_bsh {
namespace {

using Field = pcl::PCLPointField;

/// Calls use(values) with the vector behind the field.
template <typename Use>
decltype(auto) withValues(const NewField& field, const Use& use)
{
  return std::visit([&](const auto* values) -> decltype(auto) { return use(*values); }, field.values);
}

template <typename Value>
constexpr std::uint8_t datatypeOf(const std::vector<Value>&)
{
  if constexpr (std::is_enum_v<Value>)
    return pcl::traits::asEnum_v<std::underlying_type_t<Value>>;
  else
    return pcl::traits::asEnum_v<Value>;
}

void requireSame(const Field& field, std::uint8_t datatype, const pcl::PCLPointCloud2& cloud)
{
  const auto bytes = static_cast<std::size_t>(pcl::getFieldSize(datatype));
  if (field.datatype != datatype || field.count > 1 || field.offset + bytes > cloud.point_step) {
    const char* type = datatype == Field::UINT8     ? "UINT8"
                       : datatype == Field::INT32   ? "INT32"
                       : datatype == Field::FLOAT32 ? "FLOAT32"
                                                    : "FLOAT64";
    throw std::invalid_argument("field '" + field.name + "' exists already and is not one " + type +
                                " per point: rename or remove it");
  }
}

/// The cloud's header, its fields and the new ones, without a record. New fields lie packed, not aligned: padding would
/// show as fields named "_" in every file PCL writes.
pcl::PCLPointCloud2 layout(const pcl::PCLPointCloud2& cloud, const std::vector<NewField>& fields)
{
  pcl::PCLPointCloud2 result = withoutRecords(cloud);
  result.height = cloud.height;
  result.width = cloud.width;
  for (const NewField& field : fields) {
    const std::uint8_t datatype = withValues(field, [](const auto& values) { return datatypeOf(values); });
    if (const Field* present = findField(result, field.name)) {
      requireSame(*present, datatype, result);
      continue;
    }
    Field added;
    added.name = field.name;
    added.offset = result.point_step;
    added.datatype = datatype;
    added.count = 1;
    result.fields.push_back(added);
    result.point_step += static_cast<pcl::uindex_t>(pcl::getFieldSize(datatype));
  }
  result.row_step = result.point_step * result.width;
  return result;
}

} // namespace

pcl::PCLPointCloud2 withFields(const pcl::PCLPointCloud2& cloud, const std::vector<NewField>& fields)
{
  const std::size_t points = viewOf(cloud).count;
  for (const NewField& field : fields) {
    const std::size_t count = withValues(field, [](const auto& values) { return values.size(); });
    if (count != points) {
      throw std::invalid_argument("field '" + field.name + "' has " + counted(count, "value") + ": the cloud has " +
                                  counted(points, "point"));
    }
  }

  pcl::PCLPointCloud2 result = layout(cloud, fields);
  result.data.resize(points * result.point_step);
  for (std::size_t i = 0; i < points; ++i) {
    std::memcpy(&result.data[i * result.point_step], &cloud.data[i * cloud.point_step], cloud.point_step);
  }
  for (const NewField& field : fields) {
    const std::size_t offset = findField(result, field.name)->offset;
    withValues(field, [&](const auto& values) {
      for (std::size_t i = 0; i < points; ++i) {
        std::memcpy(&result.data[i * result.point_step + offset], &values[i], sizeof values[i]);
      }
    });
  }
  return result;
}

std::vector<NewField> fieldsOf(const TrajectoryResult& result)
{
  return {{collision_field_name, &result.flags},
          {distance_field_name, &result.distance},
          {first_pose_field_name, &result.first_pose},
          {closest_pose_field_name, &result.closest_pose}};
}

} // namespace pcl_bsh
