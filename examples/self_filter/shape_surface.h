// SPDX-License-Identifier: BSD-3-Clause
// The surface of a body as triangles.
#pragma once

#include "self_filter/robot.h"

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <vector>

namespace pcl_bsh::self_filter {

struct Surface {
  std::vector<Point3> vertices;
  std::vector<Triangle> triangles;
};

/// @throws std::runtime_error for a size that is not finite and above 0
void requireSize(double size, const char* what);

/// In the link's frame. What is round is a polyhedron within it.
/// @param sagitta how far that may be from what is round, m; > 0
/// @throws files::FileError for a mesh that cannot be read or has no faces; std::runtime_error for a size that is not
///   above 0, or too large for the sagitta
Surface surfaceOf(const Shape& shape, double sagitta);

} // namespace pcl_bsh::self_filter
