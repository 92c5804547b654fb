// SPDX-License-Identifier: BSD-3-Clause
// The header of a PLY file: its elements, and their properties.
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/left_out.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

struct PlyProperty {
  std::string name;
  std::uint8_t datatype = 0;
  std::optional<std::uint8_t> length_type; ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements; ///< in the order of the file
  std::uint64_t columns = 0;        ///< of an organised cloud, else 0
  std::uint64_t rows = 0;
  std::optional<Viewpoint> viewpoint; ///< of a comment
};

/// Reads up to and including end_header. @throws FormatError
PlyHeader readPlyHeader(TextCursor& text);

/// Counts an element that is not compared, unless it says nothing of a shape. Some join vertices, as their names or
/// those of their properties tell.
void leaveOut(const PlyElement& element, LeftOuts& left_out);

} // namespace pcl_bsh::io
