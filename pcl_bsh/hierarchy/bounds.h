// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace pcl_bsh {

/// Axis-aligned bounds of points as given; low > high when there are none.
struct Bounds {
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  Point3 low = {kNone, kNone, kNone};
  Point3 high = {-kNone, -kNone, -kNone};
  std::size_t finite = 0; ///< points within, where they were counted

  void add(const Point3& point) noexcept { add(point, point); }

  /// Adds all points of the box [lowest, highest].
  void add(const Point3& lowest, const Point3& highest) noexcept
  {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], lowest[k]);
      high[k] = std::max(high[k], highest[k]);
    }
  }
};

} // namespace pcl_bsh
