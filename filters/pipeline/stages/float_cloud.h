// SPDX-License-Identifier: BSD-3-Clause
// The points of a cloud as PCL's typed classes want them.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

/// The finite points, as float32 relative to an origin. PCL's search aborts the program on points that are not finite.
struct FloatCloud {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points; ///< one row: so searches are by k-d tree, right for any sensor
  std::vector<std::uint32_t> records;         ///< of each of these points, its record in the cloud
  Point3 origin = {0, 0, 0};                  ///< of float32 clouds 0, of float64 ones the middle of the points
  double moved = 0;                           ///< the most that rounding to float32 changed a coordinate
};

FloatCloud floatCloud(const PointsView& points);

/// Gives one of PCL's classes the points and their numbers. PCL would number them itself; when memory runs out there,
/// it prints a line and finds nothing.
template <typename Algorithm>
void setInput(Algorithm& algorithm, const FloatCloud& cloud)
{
  const auto all = std::make_shared<pcl::Indices>(cloud.points->size());
  std::iota(all->begin(), all->end(), 0);
  algorithm.setInputCloud(cloud.points);
  algorithm.setIndices(all);
}

/// Returns the median distance of points from their nearest neighbours: the length to compare rounding with, where a
/// search counts neighbours instead of naming a length. Infinite where nothing was rounded.
double neighbourSpacing(const PointsView& points, const FloatCloud& cloud);

/// Warning for distances that are compared with `length`; empty where rounding does not matter.
/// @throws std::invalid_argument when rounding moved points by more than a hundredth of the length: results would be
///   wrong
std::string roundingWarning(const FloatCloud& cloud, double length);

} // namespace pcl_bsh::pipeline
