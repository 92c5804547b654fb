// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/pose_file.h>
#include <pcl_bsh/filters/pipeline/stages/collision_question.h>
#include <pcl_bsh/query/trajectory.h>

#include <stdexcept>
#include <string>

namespace pcl_bsh::pipeline {
namespace {

std::vector<Eigen::Isometry3d> posesOf(const std::optional<Pose>& pose, const std::optional<InputFile>& trajectory)
{
  if (!trajectory) {
    Eigen::Isometry3d only = Eigen::Isometry3d::Identity();
    if (pose) only.matrix() = pose->matrix;
    return {only};
  }
  if (pose) throw OptionError("trajectory", "and `pose` are both given: give one of them");
  try {
    return io::readPoses(trajectory->path);
  }
  catch (const io::CloudFileError& error) {
    throw OptionError("trajectory", error.what());
  }
}

/// The core names what is wrong with a request as `what: wrong: remedy`; users know it by the option.
template <typename Ask>
void requireAccepted(const std::string& option, const Ask& ask)
{
  try {
    ask();
  }
  catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    const std::size_t colon = message.find(": ");
    throw OptionError(option, colon == std::string::npos ? message : message.substr(colon + 2));
  }
}

/// Shares the ownership of what it points into.
std::shared_ptr<const pcl::PCLPointCloud2> pointsOf(const StageCloudPtr& cloud)
{
  return {cloud, &cloud->cloud};
}

} // namespace

void CollisionQuestion::check(bool distances)
{
  poses_ = posesOf(pose, trajectory);
  TrajectoryRequest request;
  const auto follow = [&] {
    const SphereHierarchy nothing{PointsView{}};
    collideAlong({nothing}, nothing, poses_, request);
  };
  requireAccepted(trajectory ? "trajectory" : "pose", follow);
  request.clearance = clearance;
  requireAccepted("clearance", follow);
  request.distances = distances;
  requireAccepted("accuracy", [&] {
    request.accuracy = Accuracy::parse(accuracy);
    follow();
  });
  if (swept == 0) return;
  if (!trajectory) throw OptionError("swept", "is given, but nothing moves: give a `trajectory`, too");
  request.swept = swept;
  requireAccepted(request.accuracy.isExact() ? "swept" : "accuracy", follow);
}

void CollisionQuestion::setUp(Filter& filter, const StageCloudPtr& input) const
{
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
