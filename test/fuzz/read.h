// SPDX-License-Identifier: BSD-3-Clause
// What holds of every reader: it refuses with a reason, or gives a cloud that is sound and no larger than its file
// justifies.
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

/// @param parse from a file's content to a pcl::PCLPointCloud2
template <class Parse>
void readAny(const std::uint8_t* data, std::size_t size, Parse parse)
{
  try {
    pcl::PCLPointCloud2 cloud = parse(std::string_view(reinterpret_cast<const char*>(data), size));
    requireSound(cloud, size);
  }
  catch (const io::FormatError& error) {
    require(*error.what() != '\0' && !error.remedy().empty(), "a refusal without a reason");
  }
}

} // namespace pcl_bsh::fuzz
