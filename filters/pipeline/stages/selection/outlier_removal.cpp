// SPDX-License-Identifier: BSD-3-Clause
// Stages that remove outliers by one of PCL's filters.
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/float_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/statistical_outlier_removal.h>

#include <memory>

namespace pcl_bsh::pipeline {
namespace {

/// Gives PCL's filter the finite points in float32, and warns where their rounding matters.
struct OutlierRemoval : SelectingStage {
protected:
  using Filter = pcl::FilterIndices<pcl::PointXYZ>;

  /// PCL's filter with the stage's options. @throws OptionError when it cannot take so few points
  virtual std::unique_ptr<Filter> filterFor(const FloatCloud& points) const = 0;

  /// The length that distances between neighbours are compared with.
  virtual double comparedLength(const PointsView& view, const FloatCloud& points) const = 0;

  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) final
  {
    const PointsView view = viewOf(cloud->cloud);
    std::vector<std::uint8_t> passes(view.count, 0);
    const FloatCloud points = floatCloud(view);
    if (points.points->empty()) return passes;
    const std::unique_ptr<Filter> filter = filterFor(points);
    const std::string warning = roundingWarning(points, comparedLength(view, points));
    if (!warning.empty()) warn(warning);

    setInput(*filter, points);
    pcl::Indices kept;
    filter->filter(kept);
    for (const pcl::index_t i : kept) passes[points.records[static_cast<std::size_t>(i)]] = 1;
    return passes;
  }
};

struct StatisticalOutlierRemoval : OutlierRemoval {
  unsigned mean_k = 1;
  double stddev_mul_thresh = 0;

protected:
  std::unique_ptr<Filter> filterFor(const FloatCloud& points) const override
  {
    if (points.points->size() <= mean_k) { // PCL's would read beyond the neighbours it has
      throw OptionError("mean_k", "is " + std::to_string(mean_k) + ", but there are only " +
                                      std::to_string(points.points->size()) + " finite points: give less");
    }
    auto filter = std::make_unique<pcl::StatisticalOutlierRemoval<pcl::PointXYZ>>();
    filter->setMeanK(static_cast<int>(mean_k));
    filter->setStddevMulThresh(stddev_mul_thresh);
    return filter;
  }

  double comparedLength(const PointsView& view, const FloatCloud& points) const override
  {
    return neighbourSpacing(view, points);
  }
};

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

StageType statisticalOutlierRemoval()
{
  auto description =
      describe<StatisticalOutlierRemoval>(
          "filters.statistical_outlier_removal",
          "Removes points whose mean distance to their neighbours is far above the average. Neighbours are searched in "
          "float32 about the cloud's middle; coordinates stay as they are.")
          .alias("pcl::StatisticalOutlierRemoval")
          .option(&StatisticalOutlierRemoval::mean_k, "mean_k", "number of neighbours")
          .atLeast(1)
          .atMost(1e6)
          .option(
              &StatisticalOutlierRemoval::stddev_mul_thresh, "stddev_mul_thresh",
              "points whose mean distance exceeds the average by more than this many standard deviations are outliers");
  return withSelectionOptions(description);
}

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
