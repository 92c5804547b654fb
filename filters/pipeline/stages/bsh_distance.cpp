// SPDX-License-Identifier: BSD-3-Clause
// How far each point is from another cloud.
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/gathered_result.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/faces.h>
#include <pcl_bsh/filters/pipeline/stages/question_stage.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>
#include <pcl_bsh/search/cloud_view.h>

#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace pcl_bsh::pipeline {
namespace {

struct BshDistance : SelectingStage, QuestionStage {
  Limits filter_limits;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    question.limits = {limitOf(filter_limits.least, 0.0),
                       limitOf(filter_limits.most, std::numeric_limits<double>::infinity())};
    Wanted wanted;
    wanted.distances = wanted.within = true;
    QuestionStage::plan(inputs[0], wanted, *this);
    return withDistances(inputs[0], {});
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    Answer answer = ask(inputs[0], *this).answer;
    if (asksAboutFaces(*inputs[0])) return measuredFaces(std::move(inputs[0]), std::move(answer));
    auto measured = emptyLike(*inputs[0]);
    measured->cloud = withDistances(inputs[0]->cloud, answer.distances.a.distance);
    within_ = std::move(answer.within);
    inputs[0] = std::move(measured);
    return SelectingStage::run(std::move(inputs));
  }

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& /*cloud*/) override { return std::move(within_); }

private:
  /// Distances of triangles become a property of their faces; vertices get the smallest distance of their triangles.
  StageCloudPtr measuredFaces(StageCloudPtr&& input, Answer answer) const
  {
    const std::vector<Triangle>& triangles = *input->triangles;
    TrajectoryResult found;
    found.distance.assign(answer.distances.a.distance.begin(), answer.distances.a.distance.end());
    const std::vector<float> of_vertices =
        gatheredResult(found, viewOf(input->cloud).count, [&](std::size_t t) -> const Triangle& {
          return triangles[t];
        }).distance;
    const auto measured = ownCloud(std::move(input));
    measured->cloud = withDistances(measured->cloud, {of_vertices.begin(), of_vertices.end()});
    setFaceProperty(*measured, distance_field_name, std::move(found.distance));
    return keepFaces(*measured, std::move(answer.within));
  }

  static pcl::PCLPointCloud2 withDistances(const pcl::PCLPointCloud2& cloud, const std::vector<double>& distances)
  {
    const std::vector<float> told(distances.begin(), distances.end());
    return withFields(cloud, {{distance_field_name, &told}});
  }

  /// Returns a limit as a double, which distances are, too; `none` where there is no limit.
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

  std::vector<std::uint8_t> within_;
};

} // namespace

StageType bshDistance()
{
  auto description = describe<BshDistance>(
      "filters.bsh_distance",
      "Adds a field `distance` (float32): from each point to the nearest point of another cloud; keeps the points "
      "whose "
      "distance is within limits. Exact unless `accuracy` says otherwise, for float64 coordinates too. An input with "
      "faces has its triangles measured, as a property of its faces, and kept.");
  withQuestionOptions(description.alias("pcl_bsh::DistanceFilter"), QuestionKind::distances)
      .option(
          &BshDistance::filter_limits, "filter_limits",
          "[least, most] of the distances that are kept, both inclusive and compared before rounding, in m; null in "
          "place of one: no limit, not even `max_distance`");
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline
