// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/extent.h>

#include <algorithm>

namespace pcl_bsh {

void Extent::add(const Extent& other)
{
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = std::min(low[k], other.low[k]);
    high[k] = std::max(high[k], other.high[k]);
  }
}

std::optional<Extent> extentOf(const PointsView& points)
{
  std::optional<Extent> extent;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3 point = points.point(points.record(i));
    if (!isFinite(point)) continue;
    if (!extent) extent = Extent{point, point};
    extent->add({point, point});
  }
  return extent;
}

} // namespace pcl_bsh
