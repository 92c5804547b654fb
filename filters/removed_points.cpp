// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/removed_points.h>

#include <pcl_bsh/search/cloud_view.h>

#include <cmath>
#include <cstring>

namespace pcl_bsh {

void overwritePoints(pcl::PCLPointCloud2& cloud, const pcl::Indices& records, float value)
{
  const PointsView view = viewOf(cloud);
  const double wide = value;
  const bool is_float = view.scalar == Scalar::float32;
  for (const pcl::index_t i : records) {
    std::uint8_t* const record = &cloud.data[static_cast<std::size_t>(i) * view.stride];
    for (const std::size_t offset : view.offset) {
      if (is_float) {
        std::memcpy(record + offset, &value, sizeof value);
      }
      else {
        std::memcpy(record + offset, &wide, sizeof wide);
      }
    }
  }
  if (!std::isfinite(value)) cloud.is_dense = 0;
}

} // namespace pcl_bsh
