// SPDX-License-Identifier: BSD-3-Clause
// The files of meshes that a URDF names.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <filesystem>
#include <vector>

namespace pcl_bsh::self_filter {

struct Surface {
  std::vector<Point3> vertices;
  std::vector<Triangle> triangles;
};

/// Reads .stl, .obj, .ply and .off, whose unit is taken for metres, and .dae where this is compiled with assimp. Of
/// COLLADA the file's <unit> counts, and its <up_axis> does not: coordinates are those of the link, as RViz shows them.
/// @throws files::FileError
Surface readSurface(const std::filesystem::path& path);

} // namespace pcl_bsh::self_filter
