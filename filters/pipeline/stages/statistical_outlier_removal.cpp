// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/float_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/selecting_stage.h>
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/filters/statistical_outlier_removal.h>

#include <cmath>

namespace pcl_bsh::pipeline {
namespace {

struct StatisticalOutlierRemoval : SelectingStage {
  unsigned mean_k = 1;
  double stddev_mul_thresh = 0;

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    const PointsView view = viewOf(cloud->cloud);
    std::vector<std::uint8_t> passes(view.count, 0);
    const FloatCloud points = floatCloud(view);
    if (points.points->empty()) return passes;
    if (points.points->size() <= mean_k) { // PCL's would read beyond the neighbours it has
      throw OptionError("mean_k", "is " + std::to_string(mean_k) + ", but there are only " +
                                      std::to_string(points.points->size()) + " finite points: give less");
    }
    const std::string warning = roundingWarning(points, neighbourSpacing(view, points));
    if (!warning.empty()) warn(warning);

    pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
    filter.setInputCloud(points.points);
    filter.setMeanK(static_cast<int>(mean_k));
    filter.setStddevMulThresh(stddev_mul_thresh);
    pcl::Indices kept;
    filter.filter(kept);
    for (const pcl::index_t i : kept) passes[points.records[static_cast<std::size_t>(i)]] = 1;
    return passes;
  }
};

} // namespace

StageType statisticalOutlierRemoval()
{
  auto description =
      describe<StatisticalOutlierRemoval>(
          "filters.statistical_outlier_removal",
          "Removes points whose mean distance to their neighbours exceeds that of most. Neighbours are searched in "
          "float32 about the cloud's middle; coordinates stay as they are.")
          .alias("pcl::StatisticalOutlierRemoval")
          .option(&StatisticalOutlierRemoval::mean_k, "mean_k", "how many neighbours")
          .atLeast(1)
          .atMost(1e6)
          .option(&StatisticalOutlierRemoval::stddev_mul_thresh, "stddev_mul_thresh",
                  "a mean distance above the average plus so many standard deviations makes an outlier");
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline
