// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/filters/pipeline/stages/collision_question.h>
#include <pcl_bsh/filters/pipeline/stages/other_cloud.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_file.h>
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

bool CollisionQuestion::isUncertain() const
{
  return !given(uncertainty).isZero() || !given(obstacle_uncertainty).isZero();
}

Uncertainty CollisionQuestion::given(const LengthOrField& option) const
{
  return option.field.empty() ? Uncertainty(option.length) : Uncertainty(option.field, sigmas);
}

/// By the fields of the clouds to come: their points are seen when the stage runs.
void CollisionQuestion::checkUncertainties(const CloudHeader& input) const
{
  const auto require = [this](const char* name, const LengthOrField& option, const CloudHeader& cloud) {
    try {
      withUncertainty(PointsView(), cloud.fields, "cloud", given(option));
    }
    catch (const InvalidInput& error) {
      throw OptionError(name, error.advice());
    }
  };
  require("uncertainty", uncertainty, input);
  require("obstacle_uncertainty", obstacle_uncertainty, obstacle.header);
  if (sigmas != 1 && uncertainty.field.empty() && obstacle_uncertainty.field.empty())
    throw OptionError("sigmas", "is given, but no uncertainty is a field: give the length itself");
}

std::vector<std::string> CollisionQuestion::check(const CloudHeader& input, bool distances)
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
  checkUncertainties(input);
  if (density && (trajectory || distances))
    throw OptionError("density", "is for flags at one pose: leave out the trajectory, or `density`");
  checkSurface();
  if (widest_gap && !density) throw OptionError("widest_gap", "is given, but not `density`: give `density`: true, too");
  return warnings;
}

void CollisionQuestion::setUp(ObstacleQuery& filter, Stage& stage)
{
  std::vector<std::string> told;
  compared_ = obstacleOf(obstacle, clearance, Accuracy::parse(accuracy), swept > 0, stage, told);
  if (compared_.isSurface() && !obstacle_uncertainty.field.empty()) {
    throw OptionError("obstacle_uncertainty", "is a field, which the surface " + obstacle.name +
                                                  " does not have: give a length, or `vertices_only`: true");
  }
  if (compared_.isSurface() && density) told.emplace_back("a surface has no holes: `density` guards nothing");
  for (std::string& line : told) stage.warn(std::move(line));
  filter.setWarn([&stage](const std::string& line) { stage.warn(line); });
  filter.setProgress([&stage](double) { return !stage.isCancelled(); });
  if (compared_.isSurface())
    filter.setObstacleSurface(compared_.cover());
  else
    filter.setObstacleCloud(pointsOf(obstacle.cloud));
  filter.setClearance(clearance);
  filter.setPose(poses_.front());
  if (trajectory) filter.setTrajectory(poses_);
  filter.setSwept(swept);
  filter.setAccuracy(Accuracy::parse(accuracy));
  filter.setDensityGuard(density);
  filter.setWidestGap(widest_gap.value_or(0.0));
  filter.setInputUncertainty(given(uncertainty));
  filter.setObstacleUncertainty(given(obstacle_uncertainty));
  filter.setNumberOfThreads(number_of_threads);
}

void CollisionQuestion::setUp(MeshCollisionFilter& filter, const StageCloud& input, Stage& stage)
{
  if (!uncertainty.field.empty())
    throw OptionError("uncertainty", "is a field, which the input, a surface, does not have: give a length, or "
                                     "`vertices_only`: true");
  if (density) throw OptionError("density", "is about points, and the input is a surface: give `vertices_only`: true");
  setUp(filter, stage);
  std::vector<std::string> told;
  filter.setInputSurface(coverOfInput(input, clearance, stage, told));
  for (std::string& line : told) stage.warn(std::move(line));
}

std::string CollisionQuestion::undecidedWarning(const ObstacleQuery& filter, const char* parts) const
{
  const std::size_t undecided = filter.getUndecidedCount();
  if (undecided == 0) return {};
  const std::string stay = std::to_string(undecided) + ' ' + parts + " stay undecided";
  if (const std::size_t sparse = filter.getSparseCount(); sparse > 0) {
    return stay + ", of which " + std::to_string(sparse) +
           " where the obstacle is not scanned densely enough: they are not taken for free";
  }
  const char* const why = isUncertain() ? " where places are as uncertain" : " with this accuracy";
  return stay + why + ": they are not taken for free";
}

} // namespace pcl_bsh::pipeline
