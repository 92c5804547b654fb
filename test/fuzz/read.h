// SPDX-License-Identifier: BSD-3-Clause
// What holds of every reader: it refuses with a reason, or gives a cloud that is sound and no larger than its file
// justifies, with the fields that its header alone tells.
#pragma once

#include "target.h"

#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/records.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <string_view>

namespace pcl_bsh::fuzz {

/// Bytes of points per byte of file at most: what LZF can make of one.
inline constexpr std::size_t most_growth = 100;

inline void requireSound(pcl::PCLPointCloud2& cloud, std::size_t file_bytes)
{
  require(cloud.data.size() <= most_growth * (file_bytes + 1), "more memory than the file justifies");
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

/// @param parse from a file's content to a pcl::PCLPointCloud2
/// @param parse_header the same, without the points
template <class Parse, class ParseHeader>
void readAny(const std::uint8_t* data, std::size_t size, Parse parse, ParseHeader parse_header)
{
  try {
    const std::string_view file(reinterpret_cast<const char*>(data), size);
    pcl::PCLPointCloud2 cloud = parse(file);
    requireSound(cloud, size);
    requireSameFields(parse_header(file), cloud);
  }
  catch (const io::FormatError& error) {
    require(*error.what() != '\0' && !error.remedy().empty(), "a refusal without a reason");
  }
}

} // namespace pcl_bsh::fuzz
