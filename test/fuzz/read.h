// SPDX-License-Identifier: BSD-3-Clause
// Rules of every reader: it refuses with a reason, or gives a sound cloud no larger than its file justifies. Its fields
// are those that its header alone tells. Written and read again, the cloud is equal.
#pragma once

#include "target.h"

#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/format_error.h>

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace pcl_bsh::fuzz {

/// Bytes of points per byte of file at most: what LZF can make of one.
inline constexpr std::size_t most_growth = 100;

inline void requireSound(pcl::PCLPointCloud2& cloud, std::size_t file_bytes, std::size_t growth = most_growth)
{
  require(cloud.data.size() <= growth * (file_bytes + 1), "more memory than the file justifies");
  require(std::uint64_t{cloud.width} * cloud.height * cloud.point_step == cloud.data.size(),
          "width x height records do not fill the data");
  for (const pcl::PCLPointField& field : cloud.fields)
    require(std::uint64_t{field.offset} + io::sizeOf(field) <= cloud.point_step, "a field lies outside its record");
  io::setDense(cloud); // looks at every floating-point value
}

inline void requireSameFields(const pcl::PCLPointCloud2& header, const pcl::PCLPointCloud2& cloud)
{
  require(header.fields.size() == cloud.fields.size() && header.point_step == cloud.point_step,
          "a header of other fields");
  for (std::size_t i = 0; i < cloud.fields.size(); ++i) {
    const pcl::PCLPointField &told = header.fields[i], &read = cloud.fields[i];
    require(told.name == read.name && told.datatype == read.datatype && told.offset == read.offset &&
                told.count == read.count,
            "a header of other fields");
  }
}

/// Whether a field's values are the same; NaNs are, and so are colours that differ in the fourth byte of rgb.
inline bool sameValues(const pcl::PCLPointField& field, const std::uint8_t* a, const std::uint8_t* b)
{
  if (io::isPackedColour(field)) {
    std::uint32_t colours[2];
    std::memcpy(&colours[0], a, sizeof colours[0]);
    std::memcpy(&colours[1], b, sizeof colours[1]);
    const std::uint32_t seen = field.name == "rgb" ? 0xffffffU : 0xffffffffU;
    return ((colours[0] ^ colours[1]) & seen) == 0;
  }
  return io::withFieldType(field.datatype, [&](auto value) {
    auto other = value;
    for (std::size_t i = 0; i < std::max(field.count, 1U); ++i) {
      std::memcpy(&value, a + i * sizeof value, sizeof value);
      std::memcpy(&other, b + i * sizeof value, sizeof value);
      const bool both_nan = value != value && other != other;
      if (!both_nan && std::memcmp(&value, &other, sizeof value) != 0) return false;
    }
    return true;
  });
}

/// Requires that a cloud, written and read again, is equal.
inline void requireSamePoints(const pcl::PCLPointCloud2& before, const pcl::PCLPointCloud2& after)
{
  require(std::uint64_t{before.width} * before.height == std::uint64_t{after.width} * after.height,
          "another size when read again");
  require(before.fields.size() == after.fields.size(), "other fields when read again");
  for (std::size_t f = 0; f < before.fields.size(); ++f) {
    const pcl::PCLPointField &field = before.fields[f], &again = after.fields[f];
    require(field.name == again.name && field.count == again.count &&
                (field.datatype == again.datatype || io::isPackedColour(field)),
            "another field when read again");
    for (std::size_t i = 0; i < std::size_t{before.width} * before.height; ++i) {
      require(sameValues(field, &before.data[i * before.point_step + field.offset],
                         &after.data[i * after.point_step + again.offset]),
              "another value when read again");
    }
  }
}

/// The text that `write` makes of the cloud; nothing where the format cannot hold it. Fields named "_" are padding to
/// PCL.
template <class Write>
std::optional<std::string> written(const pcl::PCLPointCloud2& cloud, Write write)
{
  for (const pcl::PCLPointField& field : cloud.fields)
    if (field.name == "_") return std::nullopt;
  try {
    std::ostringstream out;
    write(out, cloud);
    return out.str();
  }
  catch (const io::FormatError&) {
    return std::nullopt;
  }
}

/// @param parse from a file's content to a pcl::PCLPointCloud2
/// @param parse_header the same, without the points
/// @param write to a stream, or refusing what the format cannot hold
/// @param growth bytes of points per byte of file at most
template <class Parse, class ParseHeader, class Write>
void readAny(const std::uint8_t* data, std::size_t size, Parse parse, ParseHeader parse_header, Write write,
             std::size_t growth = most_growth)
{
  std::optional<std::string> again;
  pcl::PCLPointCloud2 cloud;
  try {
    const std::string_view file(reinterpret_cast<const char*>(data), size);
    cloud = parse(file);
    requireSound(cloud, size, growth);
    requireSameFields(parse_header(file), cloud);
    again = written(cloud, write);
  }
  catch (const io::FormatError& error) {
    require(*error.what() != '\0' && !error.remedy().empty(), "a refusal without a reason");
  }
  if (!again) return;
  try {
    requireSamePoints(cloud, parse(*again));
  }
  catch (const io::FormatError&) {
    throw Finding("what was written is refused");
  }
}

} // namespace pcl_bsh::fuzz
