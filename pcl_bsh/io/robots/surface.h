// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of bodies as triangles, and the files of meshes that a URDF names.
#pragma once

#include <pcl_bsh/robot/robot.h>

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <filesystem>
#include <vector>

namespace pcl_bsh::io {

struct Surface {
  std::vector<Point3> vertices;
  std::vector<Triangle> triangles;

  void add(const Surface& more);

  /// The triangles as records; this object must outlive what is built on them.
  PointsView view() const;
};

/// Reads .stl, .obj, .ply and .off, whose unit is taken for metres, and .dae where this is compiled with assimp. A
/// COLLADA file's <unit> counts; its <up_axis> does not: coordinates are those of the link, as RViz shows them.
/// @throws files::FileError
Surface readSurface(const std::filesystem::path& path);

/// Returns a shape's surface in the link's frame. A round shape becomes a polyhedron inside it.
/// @param sagitta greatest distance of the polyhedron from the round shape, m; > 0
/// @pre sizes above 0
/// @throws files::FileError for a mesh that cannot be read or has no faces; FormatError for a size that is too large
///   for the sagitta
Surface surfaceOf(const robots::Shape& shape, double sagitta);

} // namespace pcl_bsh::io
