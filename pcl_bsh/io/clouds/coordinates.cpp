// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/coordinates.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/search/cloud_view.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace pcl_bsh::io {

namespace {

using CoordinateFields = std::array<std::size_t, 3>; ///< places among a cloud's fields

std::optional<CoordinateFields> coordinateFields(const pcl::PCLPointCloud2& cloud)
{
  CoordinateFields places{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto is_axis = [&](const pcl::PCLPointField& field) { return field.name == std::string(1, "xyz"[k]); };
    const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(), is_axis);
    if (std::count_if(cloud.fields.begin(), cloud.fields.end(), is_axis) != 1 || found->count > 1) return std::nullopt;
    places[k] = static_cast<std::size_t>(found - cloud.fields.begin());
  }
  return places;
}

double coordinateOf(const pcl::PCLPointField& field, const std::uint8_t* record)
{
  return withFieldType(field.datatype, [&](auto value) {
    std::memcpy(&value, record + field.offset, sizeof value);
    if constexpr (sizeof value == 8 && !std::is_floating_point_v<decltype(value)>) {
      constexpr auto limit =
          static_cast<decltype(value)>(std::int64_t{1} << 53); // up to which float64 has all integers
      bool held = value <= limit;
      if constexpr (std::is_signed_v<decltype(value)>) held = held && value >= -limit;
      if (!held)
        throw FormatError("has " + std::to_string(value) + " in '" + field.name + "', which float64 does not hold",
                          "export it with coordinates below 2^53");
    }
    return static_cast<double>(value);
  });
}

} // namespace

bool hasIntegerCoordinates(const pcl::PCLPointCloud2& cloud)
{
  const auto places = coordinateFields(cloud);
  return places && std::all_of(places->begin(), places->end(), [&](std::size_t place) {
           return withFieldType(cloud.fields[place].datatype,
                                [](auto zero) { return !std::is_floating_point_v<decltype(zero)>; });
         });
}

void makeCoordinatesPlain(pcl::PCLPointCloud2& cloud)
{
  if (!hasIntegerCoordinates(cloud)) return;
  const CoordinateFields places = *coordinateFields(cloud);
  const auto is_coordinate = [&](std::size_t f) { return std::find(places.begin(), places.end(), f) != places.end(); };
  pcl::PCLPointCloud2 plain;
  plain.header = cloud.header;
  plain.is_bigendian = cloud.is_bigendian;
  for (std::size_t f = 0; f < cloud.fields.size(); ++f) {
    const pcl::PCLPointField& field = cloud.fields[f];
    addField(plain, field.name, is_coordinate(f) ? std::uint8_t{pcl::PCLPointField::FLOAT64} : field.datatype,
             std::max(field.count, 1U));
  }
  plain.width = cloud.width;
  plain.height = cloud.height;
  const std::size_t records = cloud.data.size() / std::max(cloud.point_step, 1U);
  if (cloud.row_step > 0) plain.row_step = plain.width * plain.point_step;
  plain.data.resize(records * plain.point_step);
  for (std::size_t i = 0; i < records; ++i) {
    const std::uint8_t* const from = cloud.data.data() + i * cloud.point_step;
    std::uint8_t* const to = plain.data.data() + i * plain.point_step;
    for (std::size_t f = 0; f < cloud.fields.size(); ++f) {
      if (is_coordinate(f)) {
        const double coordinate = coordinateOf(cloud.fields[f], from);
        std::memcpy(to + plain.fields[f].offset, &coordinate, sizeof coordinate);
      }
      else {
        std::memcpy(to + plain.fields[f].offset, from + cloud.fields[f].offset, sizeOf(cloud.fields[f]));
      }
    }
  }
  cloud = std::move(plain);
}

void requireCoordinates(const pcl::PCLPointCloud2& cloud)
{
  for (const char* axis : {"x", "y", "z"}) {
    const auto is_axis = [&](const pcl::PCLPointField& field) { return field.name == axis; };
    if (std::count_if(cloud.fields.begin(), cloud.fields.end(), is_axis) > 1) {
      throw FormatError("has two fields named '" + std::string(axis) + "'", "rename one");
    }
  }
  try {
    viewOf(cloud);
  }
  catch (const std::invalid_argument& error) {
    throw FormatError(error.what(), "export it with float x y z");
  }
}

} // namespace pcl_bsh::io
