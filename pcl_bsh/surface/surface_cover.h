// SPDX-License-Identifier: BSD-3-Clause
// Surfaces as clouds: balls that hold every point of a mesh's triangles and hardly more.
//
//   SurfaceCover crate = coverSurface(viewOf(vertices_xyz, n), triangles, {0.002});  // sticks out by at most 2 mm
//   SphereHierarchy obstacle(crate.view());
//   collisionFlags({scan}, {obstacle}, {0.02});
//
// Every query compares points with their radii, so with such a cover
//   free       means farther than the clearance from the surface, for certain;
//   colliding  means within clearance + tolerance of the surface.
// The cover is conservative: no rounding leaves a point of the surface outside.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// What coverSurface() reads.
struct SurfaceRequest {
  /// How far a ball may reach beyond the surface, in the vertices' unit; finite and > 0. No ball is larger.
  double tolerance = 0.0;
  /// Each ball holds parts of one triangle only, so that its verdict is that of a triangle. Takes more balls.
  bool triangles_apart = false;
  /// Called now and then with the fraction done in [0, 1], which never falls. False: stop, coverSurface() throws
  /// Cancelled. What it throws itself comes out of coverSurface().
  std::function<bool(double)> progress;
};

/// Balls, which own their memory.
struct SurfaceCover {
  std::vector<Point3> centers;          ///< on the surface, up to rounding; in the vertices' frame and unit
  std::vector<float> radii;             ///< one per ball; <= tolerance
  std::vector<std::uint32_t> triangles; ///< one per ball: of those whose parts it holds, the one its centre lies on
  double tolerance = 0.0;
  double coordinate_spacing = 0.0; ///< of the corners, as SphereHierarchy::coordinateSpacing() has it of points
  double area = 0.0;               ///< of all triangles, rounded; what lies on another triangle counts again
  std::size_t loose = 0;           ///< finite vertices that no triangle names: no part of the surface
  std::size_t triangle_count = 0;  ///< of the mesh
  bool triangles_apart = false;    ///< as the request had it; then triangle_answers.h has answers about triangles

  /// The balls as points with radii; this object must outlive what is built on it.
  PointsView view() const noexcept;

  /// How many balls of this tolerance the best cover of a plane of this area takes, centres in a hexagonal lattice
  /// (Kershner, The Number of Circles Covering a Set, 1939): area / (1.5 sqrt(3) tolerance^2). 0 without area.
  double hexagonalOptimum() const noexcept;
};

/// Covers the triangles. Degenerate ones (a segment, a point) are covered as what they are; vertices that no triangle
/// names are not. Charts of triangles with nearly one normal are laid into a plane and divided into hexagons; each ball
/// holds what lies in one of these, and balls along the borders of charts are united where one can hold both.
/// @throws std::invalid_argument (Input::surface) when the tolerance is not finite and positive, too small for the
///   coordinates' rounding, or would take more than 2^31 - 1 balls; when a triangle names a record that is not in the
///   view, or a corner that is not finite. Cancelled.
SurfaceCover coverSurface(const PointsView& vertices, const std::vector<Triangle>& triangles,
                          const SurfaceRequest& request);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
