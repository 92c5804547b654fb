// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/outlier_removal.h>
#include <pcl_bsh/search/cloud_view.h>

namespace pcl_bsh::pipeline {

std::vector<std::uint8_t> OutlierRemoval::passing(const StageCloudPtr& cloud)
{
  const PointsView view = viewOf(cloud->cloud);
  std::vector<std::uint8_t> passes(view.count, 0);
  const FloatCloud points = floatCloud(view);
  if (points.points->empty()) return passes;
  const std::unique_ptr<Filter> filter = filterFor(points);
  const std::string warning = roundingWarning(points, comparedLength(view, points));
  if (!warning.empty()) warn(warning);

  filter->setInputCloud(points.points);
  pcl::Indices kept;
  filter->filter(kept);
  for (const pcl::index_t i : kept) passes[points.records[static_cast<std::size_t>(i)]] = 1;
  return passes;
}

} // namespace pcl_bsh::pipeline
