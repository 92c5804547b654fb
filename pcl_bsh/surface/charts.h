// SPDX-License-Identifier: BSD-3-Clause
// Charts: neighbouring triangles that lie nearly in one plane, so that one lattice serves them all, however they are
// triangulated.
#pragma once

#include <pcl_bsh/surface/mesh.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh::surface {

/// An orthonormal frame, up to rounding: x and y in the plane.
struct Plane {
  Vector3d x = Vector3d::UnitX();
  Vector3d y = Vector3d::UnitY();
  Vector3d normal = Vector3d::UnitZ();

  Vector2d at(const Vector3d& p) const { return {x.dot(p), y.dot(p)}; }
};

struct Chart {
  Plane plane;
  std::vector<std::uint32_t> triangles;
  /// The least cosine of the angle between the plane and a triangle of it: lengths shrink no further when they are
  /// laid into the plane.
  double least_cosine = 1.0;
};

double areaOf(const Corners& corners);

/// The triangle's own plane, its longest edge along x. Any plane through it where it has no area.
Plane planeOf(const Corners& corners);

/// The cosine of the angle between the triangle and a plane; of its longest edge where it has no area.
double cosineTo(const Plane& plane, const Corners& corners);

/// Each triangle in one chart, large ones first. Neighbours share an edge, by coordinates.
/// @param areas of the triangles
std::vector<Chart> growCharts(const Mesh& mesh, const std::vector<double>& areas);

/// A chart of one triangle.
Chart chartOf(const Mesh& mesh, std::uint32_t triangle);

} // namespace pcl_bsh::surface
