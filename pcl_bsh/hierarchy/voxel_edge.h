// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>

#include <array>

namespace pcl_bsh {

/// The finite points' bounds, per axis; low > high when there are none.
struct Bounds {
  std::array<double, 3> low, high;
  std::size_t finite = 0;
};

/// The power of two that puts a few thousand points into an occupied voxel on average, judged from a sample; coarse
/// enough for 21 bits per axis.
double voxelEdgeFromDensity(const PointsView& view, const Bounds& bounds);

/// The power of two nearest to the edge asked for, coarse enough for 21 bits per axis.
double voxelEdgeFromRequest(double edge, const Bounds& bounds);

} // namespace pcl_bsh
