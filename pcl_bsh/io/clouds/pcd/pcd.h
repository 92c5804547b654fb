// SPDX-License-Identifier: BSD-3-Clause
// PCL's own format, version 0.7 and those before.
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// @param remarks if not null, gets a remark where a binary file has points that its header does not count
/// @throws FormatError
pcl::PCLPointCloud2 parsePcd(std::string_view file, Viewpoint& viewpoint, std::vector<std::string>* remarks = nullptr);

/// The fields and the number of points that the header promises, without the points. @throws FormatError
pcl::PCLPointCloud2 parsePcdHeader(std::string_view file);

/// Where the points of a file begin, and how they are stored.
struct PcdBody {
  pcl::PCLPointCloud2 header; ///< as of parsePcdHeader(); of a binary file, laid out as its records are
  std::string storage;        ///< ascii, binary or binary_compressed
  std::size_t at = 0;         ///< bytes from the file's beginning
};

/// @param beginning of the file, at least its header. @throws FormatError
PcdBody findPcdBody(std::string_view beginning);

/// The header of a binary file, behind which the records of `fields` stand side by side.
/// @param padded least length of the header: blanks in its first line fill it; 0: as short as it can be
std::string binaryPcdHeader(const std::vector<pcl::PCLPointField>& fields, std::uint32_t points,
                            std::size_t padded = 0);

/// Writes binary_compressed, whose sizes are 32-bit numbers; binary when the points take 2 GiB or more.
/// @throws FormatError when a field cannot be held
void writePcd(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint);

} // namespace pcl_bsh::io
