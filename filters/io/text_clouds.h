// SPDX-License-Identifier: BSD-3-Clause
// Points as lines of text. Decimal numbers, so coordinates are float64.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <ostream>
#include <string_view>

namespace pcl_bsh::io {

/// .xyz, .txt: a point per line. @throws FormatError
pcl::PCLPointCloud2 parseColumns(std::string_view file);

/// Only the names of the columns. @throws FormatError
pcl::PCLPointCloud2 parseColumnNames(std::string_view file);

/// .obj: the `v` lines. @throws FormatError
pcl::PCLPointCloud2 parseObj(std::string_view file);

/// .off, with any of the prefixes that keep three coordinates (ST, C, N): the vertices. @throws FormatError
pcl::PCLPointCloud2 parseOff(std::string_view file);

/// A first line that names the columns, then a point per line, every number with as many digits as its type needs.
/// @throws FormatError when a field cannot be a column
void writeColumns(std::ostream& out, const pcl::PCLPointCloud2& cloud);

/// A `v` line per point. @throws FormatError when there is a field but x y z
void writeObj(std::ostream& out, const pcl::PCLPointCloud2& cloud);

} // namespace pcl_bsh::io
