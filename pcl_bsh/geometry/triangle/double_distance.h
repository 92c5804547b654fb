// SPDX-License-Identifier: BSD-3-Clause
// Distances of triangles in double arithmetic, enclosed: the first stage of TriangleDistance.
#pragma once

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/triangle/flat_triangle.h>
#include <pcl_bsh/geometry/triangle/nearest_features.h>

namespace pcl_bsh {

/// The distance of the origin from the given triangle that was laid flat.
ExactDistance::Enclosure distanceOfOrigin(const FlatTriangle<double>& triangle);

struct DoubleDistance {
  ExactDistance::Enclosure distance; ///< as far as needed to tell on which side of the reach it is
  FeaturePairs pairs;                ///< all but those that are surely not the nearest
};

/// The distance of two triangles whose corners are known within `error` in all.
///
/// Upper bound: the distance of two places which are combinations of the corners, whatever led to them. Lower bound:
/// the gap between both triangles along some direction, whatever led to it. No condition of the triangles enters
/// either.
DoubleDistance distanceOfTriangles(const Triangle3& a, const Triangle3& b, double error, double reach);

} // namespace pcl_bsh
