// SPDX-License-Identifier: BSD-3-Clause
// Keeps or flags points by whether they collide with an obstacle.
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/gathered_result.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/faces.h>
#include <pcl_bsh/filters/pipeline/stages/question_stage.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>
#include <pcl_bsh/search/cloud_view.h>

namespace pcl_bsh::pipeline {
namespace {

struct BshFlag : Stage, QuestionStage {
  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    Wanted wanted;
    wanted.flags = true;
    wanted.contacts = trajectory.has_value();
    QuestionStage::plan(inputs[0], wanted, *this);
    return withResults(inputs[0], {});
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    TrajectoryResult found = ask(inputs[0], *this).answer.collisions;
    if (asksAboutFaces(*inputs[0])) return flaggedFaces(std::move(inputs[0]), std::move(found));
    auto output = emptyLike(*inputs[0]);
    output->cloud = withResults(inputs[0]->cloud, found);
    output->triangles = inputs[0]->triangles;
    output->face_properties = inputs[0]->face_properties;
    return output;
  }

private:
  pcl::PCLPointCloud2 withResults(const pcl::PCLPointCloud2& cloud, const TrajectoryResult& found) const
  {
    return trajectory ? withFields(cloud, fieldsOf(found)) : withField(cloud, collision_field_name, found.flags);
  }

  /// Results of triangles become properties of their faces; vertices get the gravest result of their triangles.
  StageCloudPtr flaggedFaces(StageCloudPtr&& input, TrajectoryResult found) const
  {
    const std::vector<Triangle>& triangles = *input->triangles;
    const TrajectoryResult of_vertices = gatheredResult(found, viewOf(input->cloud).count,
                                                        [&](std::size_t t) -> const Triangle& { return triangles[t]; });
    const auto output = ownCloud(std::move(input));
    output->cloud = withResults(output->cloud, of_vertices);
    setFaceProperty(*output, collision_field_name, numbersOf(found.flags));
    if (!trajectory) return output;
    setFaceProperty(*output, distance_field_name, std::move(found.distance));
    setFaceProperty(*output, first_pose_field_name, std::move(found.first_pose));
    setFaceProperty(*output, closest_pose_field_name, std::move(found.closest_pose));
    return output;
  }
};

struct BshCollision : SelectingStage, QuestionStage {
  std::string keep = "free";

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    Wanted wanted;
    wanted.flags = true;
    QuestionStage::plan(inputs[0], wanted, *this);
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    if (!asksAboutFaces(*inputs[0])) return SelectingStage::run(std::move(inputs));
    return keepFaces(*inputs[0], passing(inputs[0]));
  }

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    return maskOf(ask(cloud, *this).answer.collisions.flags, keep == "free"); // what is undecided is not free
  }
};

} // namespace

StageType bshCollision()
{
  auto description = describe<BshCollision>("filters.bsh_collision",
                                            "Keeps the points that do not collide with an obstacle, or those that do. "
                                            "Exact unless `accuracy` says otherwise, for float64 coordinates too. From "
                                            "an input with faces it keeps triangles, and the vertices that they use.");
  withQuestionOptions(description.alias("pcl_bsh::CollisionFilter"), QuestionKind::collisions)
      .option(&BshCollision::keep, "keep", "the points to keep")
      .choices({"free", "colliding"});
  return withSelectionOptions(description);
}

StageType bshFlag()
{
  auto description = describe<BshFlag>(
      "filters.bsh_flag",
      "Keeps all points and adds a field `collision` (uint8): 1 for those that collide with an obstacle, 2 for those "
      "that `accuracy` or the points' uncertainties leave undecided, 3 for those that `density` does. Along a "
      "trajectory it also adds `distance` (float32, the smallest; NaN where free), `first_pose` and `closest_pose` "
      "(int32, numbers of poses from 0; -1 where free). Exact unless `accuracy` says "
      "otherwise, for float64 coordinates too. An input with faces has its triangles flagged: writers.ply writes the "
      "flags as properties of its faces, and a vertex has the gravest flag of its triangles.");
  return withQuestionOptions(description, QuestionKind::collisions);
}

} // namespace pcl_bsh::pipeline
