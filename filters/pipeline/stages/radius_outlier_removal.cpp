// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/outlier_removal.h>

#include <pcl/filters/radius_outlier_removal.h>

namespace pcl_bsh::pipeline {
namespace {

struct RadiusOutlierRemoval : OutlierRemoval {
  double radius_search = 0;
  unsigned min_neighbors_in_radius = 1;

protected:
  std::unique_ptr<Filter> filterFor(const FloatCloud&) const override
  {
    auto filter = std::make_unique<pcl::RadiusOutlierRemoval<pcl::PointXYZ>>();
    filter->setRadiusSearch(radius_search);
    filter->setMinNeighborsInRadius(static_cast<int>(min_neighbors_in_radius));
    return filter;
  }

  double comparedLength(const PointsView&, const FloatCloud&) const override { return radius_search; }
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
                  "least number of other points in the radius")
          .atMost(1e9);
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline
