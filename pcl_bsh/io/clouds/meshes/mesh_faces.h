// SPDX-License-Identifier: BSD-3-Clause
// The faces of text meshes; their vertices are read by text_clouds.h.
#pragma once

#include <pcl_bsh/io/clouds/meshes/polygons.h>

#include <string_view>

namespace pcl_bsh::io {

/// Lines `f`, of any number of corners; indices from 1, or negative ones, which count back from the vertex before the
/// line. @throws FormatError
Polygons parseObjFaces(std::string_view file);

/// The rows behind the vertices. @throws FormatError
Polygons parseOffFaces(std::string_view file);

} // namespace pcl_bsh::io
