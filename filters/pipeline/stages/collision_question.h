// SPDX-License-Identifier: BSD-3-Clause
// The question of the stages that collide clouds: an obstacle, its pose, and a clearance.
#pragma once

#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/filters/mesh_collision_filter.h>
#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/filters/pipeline/stages/surface_options.h>

#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

/// The options of a stage that derives from it, beside Stage.
struct CollisionQuestion : SurfaceOptions {
  OtherCloud obstacle;
  double clearance = 0;
  std::optional<Pose> pose;
  std::optional<InputFile> trajectory;
  double swept = 0;
  unsigned number_of_threads = 1;
  std::string accuracy = "exact";
  LengthOrField uncertainty;
  LengthOrField obstacle_uncertainty;
  double sigmas = 1;
  bool density = false;
  std::optional<double> widest_gap;

protected:
  using Filter = CollisionFilter<pcl::PCLPointCloud2>;

  /// For plan(): reads the trajectory, and refuses what the query would refuse.
  /// @param input the header of the cloud whose points are asked about
  /// @param distances whether the stage asks how near and when, beside which points collide
  /// @return what to tell the user, a line each
  /// @throws OptionError
  std::vector<std::string> check(const CloudHeader& input, bool distances);

  /// For run(): all of a filter but its input. Along a trajectory, it stops when the stage is cancelled.
  /// @param stage that warns of what the user should know
  void setUp(ObstacleQuery& filter, Stage& stage);

  /// For run(), where the input has faces that are asked about: covers it, too.
  void setUp(MeshCollisionFilter& filter, const StageCloud& input, Stage& stage);

  /// After setUp(): what the obstacle is compared as.
  const io::Obstacle& comparedObstacle() const noexcept { return compared_; }

  /// What to tell the user after a query; empty when every point is decided.
  std::string undecidedWarning(const ObstacleQuery& filter, const char* parts = "points") const;

  /// An uncertainty, with the sigmas of this stage.
  Uncertainty given(const LengthOrField& option) const;

  /// After check(): at least one.
  const std::vector<Eigen::Isometry3d>& poses() const noexcept { return poses_; }

private:
  bool isUncertain() const;
  void checkUncertainties(const CloudHeader& input) const;

  std::vector<Eigen::Isometry3d> poses_;
  io::Obstacle compared_;
};

template <typename S>
StageDescription<S>& withCollisionOptions(StageDescription<S>& description)
{
  return withSurfaceOptions(
      description.option(&S::obstacle, "obstacle", "the cloud or mesh to collide with")
          .required()
          .option(&S::clearance, "clearance", "greatest distance that counts as collision, touching included")
          .required()
          .unit("m")
          .atLeast(0)
          .option(&S::pose, "pose",
                  "of the obstacle in the input's frame; rigid, where a matrix of few printed digits stands for its "
                  "nearest "
                  "rotation; null: the frames are one")
          .option(
              &S::trajectory, "trajectory",
              "instead of `pose`, a file of poses, one a line: a point collides if it does at any; 12 or 16 numbers of "
              "a matrix, row by row, or time tx ty tz qx qy qz qw")
          .option(
              &S::swept, "swept",
              "above 0, points collide with the motion between poses, too, to this tolerance; 0: with the poses alone")
          .unit("m")
          .atLeast(0)
          .option(
              &S::accuracy, "accuracy",
              "how sure the answer is; less sure is faster: `exact`; `tolerance=LENGTH`: distances in (clearance, "
              "clearance + LENGTH] may count, too; `level=N`, `pairs=N`, `time=SECONDS`: stops early, and what stays "
              "undecided is not free. With `swept` `exact`")
          .option(
              &S::uncertainty, "uncertainty",
              "how far the input's points may truly be from where they were measured: a length, or the field that "
              "holds each point's sigma, of which `sigmas` count. A point then collides only if it does wherever the "
              "points truly are, it is free if it cannot, and else undecided, which is not free; distances are those "
              "of the measured places")
          .unit("m")
          .atLeast(0)
          .option(&S::obstacle_uncertainty, "obstacle_uncertainty", "the same for the obstacle's points")
          .unit("m")
          .atLeast(0)
          .option(&S::sigmas, "sigmas", "by how many sigmas a point may be off, where an uncertainty is a field")
          .atLeast(0)
          .option(
              &S::density, "density",
              "true: a point that is free of the obstacle's points, but within `clearance` of the surface in a hole "
              "between "
              "them, is undecided: not scanned densely enough. At one pose")
          .option(&S::widest_gap, "widest_gap",
                  "with `density`: what gapes wider in the obstacle is an opening, not a surface; null: eight times "
                  "the median "
                  "distance between its neighbouring points, too little where lines of a scan are farther apart")
          .unit("m")
          .above(0)
          .option(&S::number_of_threads, "number_of_threads",
                  "0: all of the machine's; the result is the same for any number")
          .atMost(1024));
}

} // namespace pcl_bsh::pipeline
