// SPDX-License-Identifier: BSD-3-Clause
// A chart, divided by a lattice of hexagons in its plane: what lies in one hexagon is held by one ball.
#pragma once

#include <pcl_bsh/surface/charts.h>
#include <pcl_bsh/surface/mesh.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh::surface {

/// A ball about a hexagon that lies in one triangle.
struct WholeHexagon {
  Vector3d center;
  double radius;
  std::uint32_t triangle;
};

/// What one chart gives.
struct Division {
  std::vector<WholeHexagon> whole;
  std::vector<Patch> patches; ///< of hexagons that borders of triangles cross; balls not yet fitted
};

/// Divides a chart. Hexagons are as large as the mesh's room allows for where the surface slants.
/// @param corners of the pieces; is appended to
Division divide(const Mesh& mesh, const Chart& chart, std::vector<Vector3d>& corners);

/// Cuts one convex piece in two across its longest diagonal until a ball in the mesh's room holds each part, and adds
/// these, fitted, to `patches`.
void halveUntilHeld(const Mesh& mesh, Piece piece, std::vector<Vector3d>& corners, std::vector<Patch>& patches);

} // namespace pcl_bsh::surface
