// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/float_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/selecting_stage.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/filters/radius_outlier_removal.h>

namespace pcl_bsh::pipeline {
namespace {

struct RadiusOutlierRemoval : SelectingStage {
  double radius_search = 0;
  unsigned min_neighbors_in_radius = 1;

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    const PointsView view = viewOf(cloud->cloud);
    std::vector<std::uint8_t> passes(view.count, 0);
    const FloatCloud points = floatCloud(view);
    if (points.points->empty()) return passes;
    const std::string warning = roundingWarning(points, radius_search);
    if (!warning.empty()) warn(warning);

    pcl::RadiusOutlierRemoval<pcl::PointXYZ> filter;
    filter.setInputCloud(points.points);
    filter.setRadiusSearch(radius_search);
    filter.setMinNeighborsInRadius(static_cast<int>(min_neighbors_in_radius));
    pcl::Indices kept;
    filter.filter(kept);
    for (const pcl::index_t i : kept) passes[points.records[static_cast<std::size_t>(i)]] = 1;
    return passes;
  }
};

} // namespace

StageType radiusOutlierRemoval()
{
  auto description =
      describe<RadiusOutlierRemoval>(
          "filters.radius_outlier_removal",
          "Removes points with too few neighbours in a radius. Neighbours are searched in float32 about the cloud's "
          "middle; coordinates stay as they are.")
          .alias("pcl::RadiusOutlierRemoval")
          .option(&RadiusOutlierRemoval::radius_search, "radius_search", "the radius")
          .unit("m")
          .above(0)
          .required()
          .option(&RadiusOutlierRemoval::min_neighbors_in_radius, "min_neighbors_in_radius",
                  "how many other points there must be at least")
          .atMost(1e9);
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline
