// SPDX-License-Identifier: BSD-3-Clause
// Stereolithography files, binary and ASCII: triangles, each with corners of its own.
#pragma once

#include <pcl_bsh/io/clouds/meshes/polygons.h>

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The corners, each place once, as float32 x y z. A file is binary when its size is that of the triangles which its
/// header counts, whatever its first word; many binary files begin with `solid`.
/// @param triangles if not null, is appended to
/// @throws FormatError
pcl::PCLPointCloud2 parseStl(std::string_view file, std::vector<Triangle>* triangles);

/// A solid of a text file.
struct StlSolid {
  std::string name;          ///< all that follows `solid`; may be empty
  std::size_t triangles = 0; ///< in it
};

/// In the order of the file. @throws FormatError as parseStl() does, and for a binary file, which has none
std::vector<StlSolid> parseStlSolids(std::string_view file);

/// The fields alone: how many places there are, only the corners tell.
pcl::PCLPointCloud2 parseStlHeader(std::string_view file);

} // namespace pcl_bsh::io
