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

double numberOf(const pcl::PCLPointField& field, const std::uint8_t* record)
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

/// Which of the fields are x y z. @pre there is one of each
std::vector<bool> areCoordinates(const pcl::PCLPointCloud2& cloud)
{
  std::vector<bool> are(cloud.fields.size(), false);
  const auto places = coordinateFields(cloud);
  for (const std::size_t place : places.value()) are[place] = true;
  return are;
}

/// Its fields, those that are chosen as float64; without records.
pcl::PCLPointCloud2 laidOut(const pcl::PCLPointCloud2& cloud, const std::vector<bool>& chosen)
{
  pcl::PCLPointCloud2 plain;
  plain.header = cloud.header;
  plain.is_bigendian = cloud.is_bigendian;
  plain.is_dense = cloud.is_dense;
  for (std::size_t f = 0; f < cloud.fields.size(); ++f) {
    const pcl::PCLPointField& field = cloud.fields[f];
    addField(plain, field.name, chosen[f] ? std::uint8_t{pcl::PCLPointField::FLOAT64} : field.datatype,
             std::max(field.count, 1U));
  }
  plain.width = cloud.width;
  plain.height = cloud.height;
  if (cloud.row_step > 0) plain.row_step = plain.width * plain.point_step;
  return plain;
}

/// Makes float64 of fields, in place where they are.
/// @param change what a number becomes
template <typename Change>
void makeDoubles(pcl::PCLPointCloud2& cloud, const std::vector<bool>& chosen, const Change& change)
{
  bool in_place = true;
  for (std::size_t f = 0; f < chosen.size(); ++f)
    if (chosen[f] && cloud.fields[f].datatype != pcl::PCLPointField::FLOAT64) in_place = false;
  pcl::PCLPointCloud2 plain;
  const std::size_t records = cloud.data.size() / std::max(cloud.point_step, 1U);
  if (!in_place) {
    plain = laidOut(cloud, chosen);
    plain.data.resize(records * plain.point_step);
  }
  pcl::PCLPointCloud2& target = in_place ? cloud : plain;
  for (std::size_t i = 0; i < records; ++i) {
    const std::uint8_t* const from = cloud.data.data() + i * cloud.point_step;
    std::uint8_t* const to = target.data.data() + i * target.point_step;
    for (std::size_t f = 0; f < chosen.size(); ++f) {
      if (chosen[f]) {
        const double number = change(numberOf(cloud.fields[f], from));
        std::memcpy(to + target.fields[f].offset, &number, sizeof number);
      }
      else if (!in_place) {
        std::memcpy(to + target.fields[f].offset, from + cloud.fields[f].offset, sizeOf(cloud.fields[f]));
      }
    }
  }
  if (!in_place) cloud = std::move(plain);
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
  if (hasIntegerCoordinates(cloud)) makeDoubles(cloud, areCoordinates(cloud), [](double value) { return value; });
}

void scaleLengths(pcl::PCLPointCloud2& cloud, const LengthScale& scale, const std::vector<std::string>& more)
{
  if (scale.isOne()) return;
  std::vector<bool> lengths = areCoordinates(cloud);
  for (std::size_t f = 0; f < cloud.fields.size(); ++f) {
    const pcl::PCLPointField& field = cloud.fields[f];
    if (std::find(more.begin(), more.end(), field.name) == more.end()) continue;
    if (field.count > 1)
      throw FormatError("has several numbers a point in '" + field.name + "'", "name fields of one length");
    lengths[f] = true;
  }
  makeDoubles(cloud, lengths, [&](double length) {
    const double scaled = scale(length);
    if (std::isinf(scaled) && !std::isinf(length))
      throw FormatError("has a length that float64 does not hold in the other unit", "check the units");
    return scaled;
  });
}

void makeCoordinatesDouble(pcl::PCLPointCloud2& cloud)
{
  makeDoubles(cloud, areCoordinates(cloud), [](double value) { return value; });
}

void transformPlaces(pcl::PCLPointCloud2& cloud, const SystemTransform& transform, std::uint64_t first)
{
  makeCoordinatesDouble(cloud);
  if (transform.isIdentity() || cloud.point_step == 0) return;
  const auto at = coordinateFields(cloud).value();
  const std::size_t records = cloud.data.size() / cloud.point_step;
  constexpr std::size_t at_once = 4096; // which the caches hold
  std::vector<Point3> places;
  for (std::size_t done = 0; done < records; done += places.size()) {
    places.resize(std::min(at_once, records - done));
    const auto coordinate = [&](std::size_t i, std::size_t k) {
      return cloud.data.data() + (done + i) * cloud.point_step + cloud.fields[at[k]].offset;
    };
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) std::memcpy(&places[i][k], coordinate(i, k), sizeof(double));
    transform(places, first + done);
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) std::memcpy(coordinate(i, k), &places[i][k], sizeof(double));
  }
}

void extendBy(const pcl::PCLPointCloud2& cloud, Eigen::AlignedBox3d& box)
{
  const PointsView points = viewOf(cloud);
  for (std::uint32_t i = 0; i < points.count; ++i)
    if (const Point3 p = points.point(i); isFinite(p)) box.extend(Eigen::Vector3d(p[0], p[1], p[2]));
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
