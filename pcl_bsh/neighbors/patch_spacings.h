// SPDX-License-Identifier: BSD-3-Clause
// How wide are the holes between the samples of a surface, at each of them? An object that is free of all samples may
// still touch the surface in a hole.
//
//   SphereHierarchy wall(viewOf(wall_xyz, n));
//   const std::vector<float> spacings = patchSpacings(wall, 0.5); // what gapes wider than 0.5 is an opening
//   request.spacings_of_b = spacings.data();                      // of a FlagsRequest, where b is the wall
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/query/effort.h>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// One per record of the cloud's view, in its unit: the spacing of the surface's patch at that point.
///
/// The spacing at a point is the diameter of the largest circle through it that holds no other point inside and is no
/// wider than `widest_gap`. This is the largest hole beside it in any direction, also between lines of a scan. 0: no
/// such circle, or the record is no point. Circles lie in the plane that fits the point's k nearest neighbours best
/// (least squares). Each neighbour is turned into that plane about the point, and keeps its distance. k is the first of
/// 16, 64, 256, ... whose neighbours reach beyond the circles, or beyond `widest_gap`. In double arithmetic, rounded
/// up; equal for any number of threads.
///
/// These circles are the circumcircles of the Delaunay triangles at the point. The triangles with circles up to a width
/// are the surface of an alpha shape (Edelsbrunner, Kirkpatrick, Seidel, On the shape of a set of points in the plane,
/// 1983). So where the surface is flat over a gap's width, every place of it in a hole of at most `widest_gap` is
/// within half of the spacing of one of its samples. Nothing is promised of wider holes, of edges, of surfaces nearer
/// to each other than `widest_gap`, of wires.
/// @param widest_gap > 0; what gapes wider is an opening, not a surface. Infinity: no opening, and quadratic time
/// @throws std::invalid_argument when widest_gap is not above 0, or the accuracy not exact, or the cloud of triangles.
///   Cancelled.
std::vector<float> patchSpacings(const SphereHierarchy& cloud, double widest_gap, const Effort& effort = {});

/// A widest gap for scans whose points lie about as far apart in all directions: eight times the median distance from a
/// point to its nearest neighbour (spacingOf()). 0 where no two places have points. Too little for a spinning lidar,
/// whose lines are farther apart than their points.
double usualGap(const SphereHierarchy& cloud);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
