// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/filters/pipeline/stages/collision_question.h>
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>
#include <pcl_bsh/filters/pose_files/pose_file.h>
#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <string>

namespace pcl_bsh::pipeline {
namespace {

std::vector<Eigen::Isometry3d> posesOf(const std::optional<Pose>& pose, const std::optional<InputFile>& trajectory,
                                       std::vector<std::string>& warnings)
{
  if (!trajectory) return {rigidPoseOf(pose, warnings)};
  if (pose) throw OptionError("trajectory", "and `pose` are both given: give one of them");
  try {
    return io::readPoses(trajectory->path, &warnings);
  }
  catch (const files::FileError& error) {
    throw OptionError("trajectory", error.what());
  }
}

/// The option that sets the member of a request which an error of the core names.
std::string optionOf(Input input, bool moves)
{
  switch (input) {
  case Input::clearance:
    return "clearance";
  case Input::accuracy:
    return "accuracy";
  case Input::swept:
    return "swept";
  default:
    return moves ? "trajectory" : "pose";
  }
}

} // namespace

std::vector<std::string> CollisionQuestion::check(bool distances)
{
  std::vector<std::string> warnings;
  poses_ = posesOf(pose, trajectory, warnings);
  if (swept != 0 && !trajectory) throw OptionError("swept", "is given, but nothing moves: give a `trajectory`, too");
  TrajectoryRequest request;
  request.clearance = clearance;
  request.distances = distances;
  if (swept != 0) request.swept = swept;
  try {
    request.accuracy = Accuracy::parse(accuracy);
    const SphereHierarchy nothing{PointsView{}};
    collideAlong({nothing}, nothing, poses_, request);
  }
  catch (const InvalidInput& error) {
    throw OptionError(optionOf(error.input(), trajectory.has_value()), error.advice());
  }
  return warnings;
}

void CollisionQuestion::setUp(Filter& filter, const StageCloudPtr& input, const Stage& stage) const
{
  filter.setProgress([&stage](double) { return !stage.isCancelled(); });
  filter.setInputCloud(pointsOf(input));
  filter.setObstacleCloud(pointsOf(obstacle.cloud));
  filter.setClearance(clearance);
  filter.setPose(poses_.front());
  if (trajectory) filter.setTrajectory(poses_);
  filter.setSwept(swept);
  filter.setAccuracy(Accuracy::parse(accuracy));
  filter.setNumberOfThreads(number_of_threads);
}

std::string CollisionQuestion::undecidedWarning(const Filter& filter)
{
  const std::size_t undecided = filter.getUndecidedCount();
  if (undecided == 0) return {};
  return std::to_string(undecided) + " points stay undecided with this accuracy: they are not taken for free";
}

} // namespace pcl_bsh::pipeline
