// SPDX-License-Identifier: BSD-3-Clause
// The triangles that are covered, near the origin, where doubles are finest.
#pragma once

#include <pcl_bsh/surface/surface_cover.h>

#include <Eigen/Core>

#include <array>
#include <vector>

namespace pcl_bsh::surface {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

struct Mesh {
  const std::vector<Triangle>& triangles;
  Vector3d middle = Vector3d::Zero(); ///< of the vertices' box; exact
  std::vector<Vector3d> vertices;     ///< less the middle, rounded; zero where no triangle names them
  double extent = 0.0;                ///< of the coordinates about the middle: none is greater
  double magnitude = 0.0;             ///< of the coordinates as given: the greatest
  /// Of all roundings together: from a point of the surface to where a computed piece has it, and back to a centre in
  /// the caller's frame.
  double error = 0.0;
  double room = 0.0; ///< no radius may exceed this, so that what is rounded up is still within the tolerance

  Corners corners(std::uint32_t triangle) const
  {
    const Triangle& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

/// A convex polygon of a triangle: consecutive corners in an array that the pieces share.
struct Piece {
  std::uint32_t triangle = 0;
  std::uint32_t count = 0;
  std::size_t first = 0;
};

/// Pieces that one ball holds, its centre on one of them.
struct Patch {
  std::vector<Piece> pieces;
  Vector3d center = Vector3d::Zero();
  double radius = 0.0;
  std::uint32_t triangle = 0;         ///< which the centre lies on
  Vector3d middle = Vector3d::Zero(); ///< of the smallest ball that holds the pieces, wherever its centre lies
  double least = 0.0;                 ///< the radius of that
};

} // namespace pcl_bsh::surface
