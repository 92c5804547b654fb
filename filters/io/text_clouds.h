// SPDX-License-Identifier: BSD-3-Clause
// Points as lines of text. Decimal numbers, so coordinates are float64.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <string_view>

namespace pcl_bsh::io {

/// .xyz, .txt: a point per line. @throws FormatError
pcl::PCLPointCloud2 parseColumns(std::string_view file);

/// .obj: the `v` lines. @throws FormatError
pcl::PCLPointCloud2 parseObj(std::string_view file);

/// .off, with any of the prefixes that keep three coordinates (ST, C, N): the vertices. @throws FormatError
pcl::PCLPointCloud2 parseOff(std::string_view file);

} // namespace pcl_bsh::io
