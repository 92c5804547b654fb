// SPDX-License-Identifier: BSD-3-Clause
// The faces of text meshes; their vertices are read by text_clouds.h.
#pragma once

#include <pcl_bsh/io/clouds/meshes/polygons.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The lines of an .obj: a backslash at the end of one joins the next to it.
inline TextCursor objText(std::string_view file)
{
  return TextCursor(file, '#', TextCursor::Lines::continued);
}

/// How many of something the comments before the first other line promise, like MeshLab's `# Vertices: 8`, or
/// `# 8 vertices`.
/// @param one, many the noun in small letters
std::optional<std::uint64_t> objPromise(std::string_view file, std::string_view one, std::string_view many);

/// Lines `f`, of any number of corners; indices from 1, or negative ones, which count back from the vertex before the
/// line. Lines and free-form curves and surfaces are left out.
/// @param remarks if not null, gets one where a comment `# Faces: 12` counts neither these nor their triangles
/// @throws FormatError
Polygons parseObjFaces(std::string_view file, std::vector<std::string>* remarks = nullptr);

/// Reads the faces of an .off, the rows behind its vertices. @throws FormatError
Polygons parseOffFaces(std::string_view file);

} // namespace pcl_bsh::io
