// SPDX-License-Identifier: BSD-3-Clause
// The Stanford polygon format; its vertices are the points.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <ostream>
#include <string_view>

namespace pcl_bsh::io {

/// @throws FormatError
pcl::PCLPointCloud2 parsePly(std::string_view file);

/// The vertices' fields and the number of them that the header promises, without the points. @throws FormatError
pcl::PCLPointCloud2 parsePlyHeader(std::string_view file);

/// Writes binary in this machine's byte order. A field with a count is a list property, as PCL's own writer has it.
/// @throws FormatError when a field cannot be held
void writePly(std::ostream& out, const pcl::PCLPointCloud2& cloud);

} // namespace pcl_bsh::io
