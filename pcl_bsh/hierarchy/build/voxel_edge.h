// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/bounds.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <algorithm>

namespace pcl_bsh {

/// How many evenly spread points of a view tell enough about its density.
inline std::size_t sampleSize(const PointsView& view) noexcept
{
  return std::min(view.size(), std::max<std::size_t>(4096, view.size() / 256));
}

/// The record of the i-th of sampleSize() points.
inline std::uint32_t sampleRecord(const PointsView& view, std::size_t i) noexcept
{
  return view.record(i * view.size() / sampleSize(view));
}

/// The power of two that puts a few thousand points into an occupied voxel on average, judged from a sample; coarse
/// enough for 21 bits per axis.
double voxelEdgeFromDensity(const PointsView& view, const Bounds& bounds);

/// The power of two nearest to the edge asked for, coarse enough for 21 bits per axis.
double voxelEdgeFromRequest(double edge, const Bounds& bounds);

} // namespace pcl_bsh
