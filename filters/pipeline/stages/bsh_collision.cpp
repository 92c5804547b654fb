// SPDX-License-Identifier: BSD-3-Clause
// This project's own filter.
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/collision_question.h>
#include <pcl_bsh/filters/pipeline/stages/selecting_stage.h>

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
    auto output = std::make_shared<StageCloud>();
    output->viewpoint = inputs[0]->viewpoint;
    output->las_header = inputs[0]->las_header;
    output->triangles = inputs[0]->triangles;
    Filter filter;
    for (std::string& line : setUp(filter, inputs[0], *this)) warn(std::move(line));
    filter.setKeepFlagged(true);
    filter.filter(output->cloud);
    if (const std::string warning = undecidedWarning(filter); !warning.empty()) warn(warning);
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

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    Filter filter;
    for (std::string& line : setUp(filter, cloud, *this)) warn(std::move(line));
    std::vector<std::uint8_t> flags;
    filter.computeFlags(flags);
    if (const std::string warning = undecidedWarning(filter); !warning.empty()) warn(warning);
    const bool colliding = keep == "colliding";
    for (std::uint8_t& flag : flags) flag = (flag != 0) == colliding; // undecided points are not free
    return flags;
  }
};

} // namespace

StageType bshCollision()
{
  auto description = describe<BshCollision>("filters.bsh_collision",
                                            "Keeps the points that do not collide with an obstacle, or those that do. "
                                            "Exact unless `accuracy` says otherwise, for float64 coordinates too.");
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
      "otherwise, for float64 coordinates too.");
  return withCollisionOptions(description);
}

} // namespace pcl_bsh::pipeline
