// SPDX-License-Identifier: BSD-3-Clause
// This project's own filter.
#include <pcl_bsh/filters/collision_field.h>
#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/selecting_stage.h>
#include <pcl_bsh/query/collide.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::pipeline {
namespace {

using Filter = CollisionFilter<pcl::PCLPointCloud2>;

/// Shares the ownership of what it points into.
std::shared_ptr<const pcl::PCLPointCloud2> pointsOf(const StageCloudPtr& cloud)
{
  return {cloud, &cloud->cloud};
}

/// The core names what is wrong with a request as `what: wrong: remedy`; users know it by the option.
void requireAccepted(const std::string& option, const Eigen::Isometry3d& pose, double clearance)
{
  CollisionRequest request;
  request.clearance = clearance;
  try {
    const SphereHierarchy nothing{PointsView{}};
    anyCollision({nothing}, {nothing, pose}, request);
  }
  catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    const std::size_t colon = message.find(": ");
    throw OptionError(option, colon == std::string::npos ? message : message.substr(colon + 2));
  }
}

/// What both stages ask for, atop of Stage or of SelectingStage.
template <typename Base>
struct CollisionStage : Base {
  OtherCloud obstacle;
  double clearance = 0;
  Pose pose;
  unsigned number_of_threads = 1;

  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    requireAccepted("clearance", Eigen::Isometry3d::Identity(), clearance);
    requireAccepted("pose", poseOfObstacle(), 0);
    return inputs[0];
  }

protected:
  Eigen::Isometry3d poseOfObstacle() const
  {
    Eigen::Isometry3d isometry;
    isometry.matrix() = pose.matrix;
    return isometry;
  }

  void setUp(Filter& filter, const StageCloudPtr& input) const
  {
    filter.setInputCloud(pointsOf(input));
    filter.setObstacleCloud(pointsOf(obstacle.cloud));
    filter.setClearance(clearance);
    filter.setPose(poseOfObstacle());
    filter.setNumberOfThreads(number_of_threads);
  }
};

struct BshFlag : CollisionStage<Stage> {
  CloudHeader plan(const std::vector<CloudHeader>& inputs) override
  {
    CollisionStage::plan(inputs);
    return withField(inputs[0], collision_field_name, {});
  }

  StageCloudPtr run(StageClouds&& inputs) override
  {
    auto output = std::make_shared<StageCloud>();
    output->viewpoint = inputs[0]->viewpoint;
    Filter filter;
    setUp(filter, inputs[0]);
    filter.setKeepFlagged(true);
    filter.filter(output->cloud);
    return output;
  }
};

struct BshCollision : CollisionStage<SelectingStage> {
  std::string keep = "free";

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    Filter filter;
    setUp(filter, cloud);
    std::vector<std::uint8_t> flags;
    filter.computeFlags(flags);
    const std::uint8_t wanted = keep == "colliding" ? 1 : 0;
    for (std::uint8_t& flag : flags) flag = flag == wanted;
    return flags;
  }
};

template <typename S>
StageDescription<S> describeCollision(const std::string& name, const std::string& doc)
{
  return describe<S>(name, doc)
      .option(&S::obstacle, "obstacle", "the cloud to collide with")
      .required()
      .option(&S::clearance, "clearance", "greatest distance that counts as collision, touching included")
      .unit("m")
      .atLeast(0)
      .option(&S::pose, "pose", "of the obstacle in the input's frame; rigid")
      .option(&S::number_of_threads, "number_of_threads", "0: all of the machine's; the result is the same")
      .atMost(1024);
}

} // namespace

StageType bshCollision()
{
  auto description = describeCollision<BshCollision>(
                         "filters.bsh_collision",
                         "Keeps the points that do not collide with an obstacle, or those that do. Exact, for float64 "
                         "coordinates too.")
                         .alias("pcl_bsh::CollisionFilter")
                         .option(&BshCollision::keep, "keep", "which points")
                         .choices({"free", "colliding"});
  return withSelectionOptions(description);
}

StageType bshFlag()
{
  return describeCollision<BshFlag>("filters.bsh_flag",
                                    "Keeps all points and adds a field `collision` (uint8): 1 for those that collide "
                                    "with an obstacle. Exact, for float64 coordinates too.");
}

} // namespace pcl_bsh::pipeline
