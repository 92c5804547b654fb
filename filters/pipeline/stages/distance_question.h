// SPDX-License-Identifier: BSD-3-Clause
// The question of the stages that measure distances: another cloud, its pose, and how far to look.
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/filters/pipeline/stages/surface_options.h>

#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

/// The options of a stage that derives from it, beside Stage.
struct DistanceQuestion : SurfaceOptions {
  OtherCloud obstacle;
  std::optional<Pose> pose;
  std::optional<double> max_distance;
  std::string accuracy = "exact";
  unsigned number_of_threads = 1;

protected:
  /// For plan(): refuses what the query would refuse.
  /// @return what to tell the user, a line each
  /// @throws OptionError
  std::vector<std::string> check();

  /// Stops when the stage is cancelled.
  PointDistancesRequest request(const Stage& stage) const;

  /// For run(): what the obstacle is compared as.
  /// @param told what the user should know is appended, a line each
  io::Obstacle comparedObstacle(const Stage& stage, std::vector<std::string>& told) const
  {
    return obstacleOf(obstacle, 0.0, Accuracy::parse(accuracy), false, stage, told);
  }

  /// After check(): of the obstacle, in the input's frame.
  const Eigen::Isometry3d& obstaclePose() const noexcept { return obstacle_pose_; }

private:
  Eigen::Isometry3d obstacle_pose_ = Eigen::Isometry3d::Identity();
};

template <typename S>
StageDescription<S>& withDistanceOptions(StageDescription<S>& description)
{
  return withSurfaceOptions(
      description.option(&S::obstacle, "obstacle", "the cloud or mesh that distances lead to")
          .required()
          .option(&S::pose, "pose",
                  "of the obstacle in the input's frame; rigid, where a matrix of few printed digits stands for its "
                  "nearest "
                  "rotation; null: the frames are one")
          .option(&S::max_distance, "max_distance",
                  "greater distances are not told, but are NaN; less is faster; null: no limit")
          .unit("m")
          .atLeast(0)
          .option(
              &S::accuracy, "accuracy",
              "how sure distances are; less sure is faster: `exact`; `tolerance=LENGTH`: that much too great at most")
          .option(&S::number_of_threads, "number_of_threads",
                  "0: all of the machine's; the result is the same for any number")
          .atMost(1024));
}

} // namespace pcl_bsh::pipeline
