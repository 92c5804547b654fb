// SPDX-License-Identifier: BSD-3-Clause
// The box about some points, or triangles, along the axes of their frame.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <cstddef>
#include <cstdint>
#include <optional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Both corners inclusive, in the clouds' unit.
struct Extent {
  Point3 low = {}, high = {};

  /// Grows to hold it.
  void add(const Extent& other);

  /// Whether the two come within `nearness` of each other along each axis.
  bool isNear(const Extent& other, double nearness) const
  {
    for (std::size_t k = 0; k < 3; ++k) {
      if (low[k] - other.high[k] > nearness || other.low[k] - high[k] > nearness) return false;
    }
    return true;
  }
};

/// The extent of a point, without its radius, or of a triangle.
Extent extentOf(const PointsView& points, std::uint32_t record);

/// The extent of all finite points, or triangles; nothing where no record is finite.
std::optional<Extent> extentOf(const PointsView& points);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
