// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/extent.h>

#include <pcl_bsh/hierarchy/record_corners.h>

#include <algorithm>

namespace pcl_bsh {

void Extent::add(const Extent& other)
{
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = std::min(low[k], other.low[k]);
    high[k] = std::max(high[k], other.high[k]);
  }
}

Extent extentOf(const PointsView& points, std::uint32_t record)
{
  const Corners corners = cornersOf(points, record);
  Extent extent{corners.at[0], corners.at[0]};
  for (std::uint32_t i = 1; i < corners.count; ++i) extent.add({corners.at[i], corners.at[i]});
  return extent;
}

std::optional<Extent> extentOf(const PointsView& points)
{
  std::optional<Extent> extent;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t record = points.record(i);
    if (!isFinite(points.point(record))) continue;
    const Extent of_record = extentOf(points, record);
    if (!extent) extent = of_record;
    extent->add(of_record);
  }
  return extent;
}

} // namespace pcl_bsh
