// SPDX-License-Identifier: BSD-3-Clause
// Faces of any number of corners, cut into triangles.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Appends the triangles of one polygon. A convex one is a fan, others are cut by clipping ears (Meisters, Polygons
/// Have Ears, 1975) in the plane of their vector area. A polygon that crosses itself is a fan of its first corner: that
/// covers all of it, and more. One or two corners have no surface, and give nothing.
/// @param polygon `count` records of the view
/// @throws std::invalid_argument (Input::surface) when a corner is not in the view, or when there are more than 4096
///   and the polygon is not convex
void addTriangles(const PointsView& vertices, const std::uint32_t* polygon, std::size_t count,
                  std::vector<Triangle>& triangles);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
