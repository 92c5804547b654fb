// SPDX-License-Identifier: BSD-3-Clause
// This project's own filter.
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/collision_question.h>
#include <pcl_bsh/filters/pipeline/stages/faces.h>
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>
#include <pcl_bsh/search/cloud_view.h>

namespace pcl_bsh::pipeline {
namespace {

struct BshFlag : Stage, CollisionQuestion {
  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    for (std::string& warning : check(inputs[0], trajectory.has_value())) warn(std::move(warning));
    const TrajectoryResult nothing;
    return trajectory ? withFields(inputs[0], fieldsOf(nothing)) : withField(inputs[0], collision_field_name, {});
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    if (asksAboutFaces(*inputs[0])) return flaggedFaces(std::move(inputs[0]));
    auto output = std::make_shared<StageCloud>();
    output->viewpoint = inputs[0]->viewpoint;
    output->las_header = inputs[0]->las_header;
    output->triangles = inputs[0]->triangles;
    output->face_properties = inputs[0]->face_properties;
    Filter filter;
    setUp(filter, *this);
    filter.setInputCloud(pointsOf(inputs[0]));
    filter.setKeepFlagged(true);
    filter.filter(output->cloud);
    if (const std::string warning = undecidedWarning(filter); !warning.empty()) warn(warning);
    return output;
  }

private:
  /// What is found of the triangles becomes properties of theirs; vertices get the gravest of what their triangles
  /// have.
  StageCloudPtr flaggedFaces(StageCloudPtr&& input)
  {
    MeshCollisionFilter filter;
    setUp(filter, *input, *this);
    TrajectoryResult found;
    if (trajectory)
      filter.computeTrajectory(found);
    else
      filter.computeFlags(found.flags);
    if (const std::string warning = undecidedWarning(filter, "triangles"); !warning.empty()) warn(warning);
    const TrajectoryResult of_vertices = ofVertices(*input->triangles, viewOf(input->cloud).count, found);
    const auto output = ownCloud(std::move(input));
    output->cloud = trajectory ? withFields(output->cloud, fieldsOf(of_vertices))
                               : withField(output->cloud, collision_field_name, of_vertices.flags);
    setFaceProperty(*output, collision_field_name, std::move(found.flags));
    if (!trajectory) return output;
    setFaceProperty(*output, distance_field_name, std::move(found.distance));
    setFaceProperty(*output, first_pose_field_name, std::move(found.first_pose));
    setFaceProperty(*output, closest_pose_field_name, std::move(found.closest_pose));
    return output;
  }
};

struct BshCollision : SelectingStage, CollisionQuestion {
  std::string keep = "free";

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    for (std::string& warning : check(inputs[0], false)) warn(std::move(warning));
    return inputs[0];
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    return asksAboutFaces(*inputs[0]) ? passingFaces(*inputs[0]) : SelectingStage::run(std::move(inputs));
  }

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    Filter filter;
    setUp(filter, *this);
    filter.setInputCloud(pointsOf(cloud));
    std::vector<std::uint8_t> flags;
    filter.computeFlags(flags);
    if (const std::string warning = undecidedWarning(filter); !warning.empty()) warn(warning);
    const bool colliding = keep == "colliding";
    for (std::uint8_t& flag : flags) flag = (flag != 0) == colliding; // undecided points are not free
    return flags;
  }

private:
  StageCloudPtr passingFaces(const StageCloud& input)
  {
    if (keep_organized)
      throw OptionError("keep_organized", "is about points, and the input is a surface: leave it out, or give "
                                          "`vertices_only`: true");
    MeshCollisionFilter filter;
    setUp(filter, input, *this);
    std::vector<std::uint8_t> flags;
    filter.computeFlags(flags);
    if (const std::string warning = undecidedWarning(filter, "triangles"); !warning.empty()) warn(warning);
    const bool colliding = (keep == "colliding") != negative; // undecided triangles are not free
    for (std::uint8_t& flag : flags) flag = (flag != 0) == colliding;
    return keptFaces(input, flags);
  }
};

} // namespace

StageType bshCollision()
{
  auto description = describe<BshCollision>(
      "filters.bsh_collision", "Keeps the points that do not collide with an obstacle, or those that do. "
                               "Exact unless `accuracy` says otherwise, for float64 coordinates too. Of an input "
                               "with faces, it keeps triangles, and the vertices that they use.");
  withCollisionOptions(description.alias("pcl_bsh::CollisionFilter"))
      .option(&BshCollision::keep, "keep", "the points to keep")
      .choices({"free", "colliding"});
  return withSelectionOptions(description);
}

StageType bshFlag()
{
  auto description = describe<BshFlag>(
      "filters.bsh_flag",
      "Keeps all points and adds a field `collision` (uint8): 1 for those that collide with an obstacle, 2 for those "
      "that `accuracy` or the points' uncertainties leave undecided, 3 for those that `density` does; along a "
      "trajectory also `distance` (float32, the "
      "smallest; NaN where free), "
      "`first_pose` and `closest_pose` (int32, numbers of poses from 0; -1 where free). Exact unless `accuracy` says "
      "otherwise, for float64 coordinates too. Of an input with faces, triangles are flagged: writers.ply writes the "
      "same "
      "as properties of its faces, and a vertex has the gravest of what its triangles have.");
  return withCollisionOptions(description);
}

} // namespace pcl_bsh::pipeline
