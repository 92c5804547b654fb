// SPDX-License-Identifier: BSD-3-Clause
// Triangles against a solid: a triangle that does not touch the solid's surface is inside where a corner is.
//
// A triangle and a solid collide at clearance 0 where the triangle touches the surface, which queries of surfaces
// decide, or where it is labelled here. Two solids collide where their surfaces do, or where one holds a shell of the
// other: holdsAny() both ways.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/solid/solid.h>

#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// One per triangle, a Label as a number: inside where a corner is, else surface where a corner is on it, else outside.
/// Triangles that are not finite are outside. A triangle that is outside may still pass through the solid, across its
/// surface.
/// @param threads 0: all of the machine's
/// @throws InvalidInput for a view that viewOf() refuses, std::invalid_argument when a pose is not rigid
std::vector<std::uint8_t> labelTriangles(const TrianglesView& triangles, const Eigen::Isometry3d& T_world_triangles,
                                         const PlacedSolid& solid, unsigned threads = 1);

/// Returns the first finite triangle of each connected shell, ascending. Triangles that name the same vertex are of one
/// shell.
/// @throws InvalidInput for a view that viewOf() refuses
std::vector<std::uint32_t> firstOfShells(const TrianglesView& triangles);

/// Whether a corner of any of these triangles is inside the solid, or on its surface. For shells that do not touch the
/// surface, one triangle of each tells all: firstOfShells().
/// @param shells triangles of the view @throws std::invalid_argument when a pose is not rigid
bool holdsAny(const PlacedSolid& solid, const TrianglesView& triangles, const std::vector<std::uint32_t>& shells,
              const Eigen::Isometry3d& T_world_triangles);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
