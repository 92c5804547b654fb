// SPDX-License-Identifier: BSD-3-Clause
// PCL's own format, version 0.7 and its elders.
#pragma once

#include <pcl_bsh/filters/cloud_files/cloud_file.h>

#include <ostream>
#include <string_view>

namespace pcl_bsh::io {

/// @throws FormatError
pcl::PCLPointCloud2 parsePcd(std::string_view file, Viewpoint& viewpoint);

/// The fields and the number of points that the header promises, without the points. @throws FormatError
pcl::PCLPointCloud2 parsePcdHeader(std::string_view file);

/// Writes binary_compressed, whose sizes are 32-bit numbers; binary when the points take 2 GiB or more.
/// @throws FormatError when a field cannot be held
void writePcd(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint);

} // namespace pcl_bsh::io
