// SPDX-License-Identifier: BSD-3-Clause
// Shared by a robot's questions: its parts, the obstacles, and gaps of these.
#pragma once

#include <pcl_bsh/robot/distance_field.h>
#include <pcl_bsh/robot/parts.h>
#include <pcl_bsh/robot/robot_world.h>

#include <optional>
#include <vector>

namespace pcl_bsh::robots {

/// A robot in one place among obstacles. Expects the DefaultFloatEnvironment.
class Gaps {
public:
  Gaps(Robot robot, std::vector<Obstacle> obstacles, const WorldOptions& options);
  Gaps(const Gaps&) = delete;
  Gaps& operator=(const Gaps&) = delete;

  /// Places of a body's parts are in the world.
  using Poses = std::vector<Kinematics::Pose>;

  Eigen::Vector3d centerOf(const Ball& ball, const Poses& poses) const { return poses[ball.body] * ball.center; }

  /// Bounds of the gap between a place and all obstacles; the nearer one takes longer.
  Interval roughly(const Eigen::Vector3d& place, double enough) const
  {
    const Interval gap = coarse_->gap(place);
    return gap.lower > enough ? gap : fine_->gap(place);
  }

  /// The gap between a ball's piece, with its padding, and all obstacles, up to the limit.
  Gap toObstacles(const Ball& ball, const Poses& poses, double limit, std::size_t& obstacle) const;

  /// The gap between the pieces of two balls, with their paddings. Beyond the limit the upper bound may be infinite.
  Interval between(const Ball& a, const Ball& b, const Poses& poses, double limit) const;

  Meeting meetingOf(const Ball& ball, std::size_t obstacle, std::uint32_t record) const;
  Meeting meetingOf(const Ball& a, const Ball& b) const;

  /// At least how far a computed gap is off, at values up to these.
  double error(const RobotState& largest) const;

  /// @param several what errors call it, with its number: a state, or a motion; null: it is the only one
  void requireState(const RobotState& state, const char* several = nullptr, std::size_t number = 0) const;

  const Robot robot;
  const WorldOptions options;
  const Kinematics kinematics;
  const Kinematics::Pose base;
  const Parts parts;
  const std::vector<Obstacle> obstacles;

private:
  Gap meshToObstacle(const Piece& piece, const Kinematics::Pose& pose, const Obstacle& obstacle, double limit) const;

  std::optional<DistanceField> coarse_, fine_;
};

} // namespace pcl_bsh::robots
