// SPDX-License-Identifier: BSD-3-Clause
// Distances to the balls that cover a surface, told as distances to the surface.
//
// Each ball holds what lies on it and reaches beyond the surface by at most the tolerance. So of the least distance d
// to a ball, less its radius, the distance to the surface is in [d, d + tolerance], up to the rounding of d. It is
// negative within a ball, where 0 is as true.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/surface/surface_cover.h>
#include <pcl_bsh/trajectory/trajectory.h>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Negative distances become 0; intervals hold those to a surface whose cover has this tolerance.
void tellOfSurface(double tolerance, DistanceResult& found);
void tellOfSurface(double tolerance, PointDistances& found);
void tellOfSurface(double tolerance, SymmetricDistances& found); ///< of b, too, which is the surface
void tellOfSurface(TrajectoryResult& found);

/// From a result about the balls of a surface that is asked about to one about its triangles: flags, counts, distances,
/// poses, where the result has them. Summaries of poses, which count balls, are left out.
/// @throws std::invalid_argument as triangleVerdicts() does
TrajectoryResult ofTriangles(const SurfaceCover& cover, TrajectoryResult balls);

/// The same of distances, each with its nearest record of the other hierarchy. Intervals are left out.
PointDistances ofTriangles(const SurfaceCover& cover, PointDistances balls);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
