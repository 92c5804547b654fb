// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/outlier_removal.h>

#include <pcl/filters/statistical_outlier_removal.h>

namespace pcl_bsh::pipeline {
namespace {

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

} // namespace pcl_bsh::pipeline
