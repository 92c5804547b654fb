// SPDX-License-Identifier: BSD-3-Clause
// How far each point is from another cloud.
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/distance_filter.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/distance_question.h>
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/selection/exact_limits.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>

namespace pcl_bsh::pipeline {
namespace {

struct BshDistance : Stage, DistanceQuestion, SelectionOptions {
  Limits filter_limits;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    for (std::string& warning : check()) warn(std::move(warning));
    if (areCrossed(filter_limits)) throw OptionError("filter_limits", "has a least above its most: exchange them");
    if (!(limitOf(filter_limits.least, 0.0) >= 0.0) || !(limitOf(filter_limits.most, 0.0) >= 0.0))
      throw OptionError("filter_limits", "has a limit below 0: give lengths, or null");
    const std::vector<float> nothing;
    return withFields(inputs[0], {{distance_field_name, &nothing}});
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    requirePoints(*inputs[0]);
    DistanceFilter<pcl::PCLPointCloud2> filter;
    filter.setInputCloud(pointsOf(inputs[0]));
    std::vector<std::string> told;
    const io::Obstacle other = comparedObstacle(*this, told);
    for (std::string& line : told) warn(std::move(line));
    if (other.isSurface())
      filter.setObstacleSurface(other.cover());
    else
      filter.setObstacleCloud(pointsOf(obstacle.cloud));
    filter.setWarn([this](const std::string& line) { warn(line); });
    filter.setPose(obstaclePose());
    filter.setFilterLimits(limitOf(filter_limits.least, 0.0),
                           limitOf(filter_limits.most, std::numeric_limits<double>::infinity()));
    const PointDistancesRequest asked = request(*this);
    filter.setMaxDistance(asked.max_distance);
    filter.setAccuracy(asked.accuracy);
    filter.setNumberOfThreads(asked.threads);
    filter.setProgress(asked.progress);
    filter.setNegative(negative);
    filter.setKeepOrganized(keep_organized);
    filter.setUserFilterValue(filterValue());
    auto output = std::make_shared<StageCloud>();
    output->viewpoint = inputs[0]->viewpoint;
    output->las_header = inputs[0]->las_header;
    filter.filter(output->cloud);
    return output;
  }

private:
  /// As a double, which distances are, too.
  static double limitOf(const Limit& limit, double none)
  {
    return std::visit(
        [none](auto number) {
          if constexpr (std::is_same_v<decltype(number), std::monostate>) {
            return none;
          }
          else {
            return static_cast<double>(number);
          }
        },
        limit);
  }
};

} // namespace

StageType bshDistance()
{
  auto description = describe<BshDistance>(
      "filters.bsh_distance",
      "Adds a field `distance` (float32): from each point to the nearest point of another cloud; keeps the points "
      "whose "
      "distance is within limits. Exact unless `accuracy` says otherwise, for float64 coordinates too.");
  withDistanceOptions(description.alias("pcl_bsh::DistanceFilter"))
      .option(
          &BshDistance::filter_limits, "filter_limits",
          "[least, most] of the distances that are kept, both inclusive and compared before rounding, in m; null in "
          "place of one: no limit, not even `max_distance`");
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline
