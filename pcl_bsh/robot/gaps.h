// SPDX-License-Identifier: BSD-3-Clause
// Shared by a robot's questions: its parts, the obstacles, and gaps of these.
#pragma once

#include <pcl_bsh/robot/obstacle_gap.h>
#include <pcl_bsh/robot/parts.h>
#include <pcl_bsh/robot/robot_world.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace pcl_bsh::robots {

/// The gap between a piece and all obstacles, and the obstacles that its two records are of.
struct ObstacleGap : Gap {
  std::size_t of_record = 0, of_possible = 0;
};

/// A robot in one place among obstacles. Gaps hold for all values of joints and all places of points within their
/// uncertainties at once. A piece is certainly no nearer than the lower bound, and certainly no farther than the upper
/// one. Expects the DefaultFloatEnvironment.
class Gaps {
public:
  Gaps(Robot robot, std::vector<Obstacle> obstacles, const WorldOptions& options);
  Gaps(const Gaps&) = delete;
  Gaps& operator=(const Gaps&) = delete;

  void setObstacles(std::vector<Obstacle> obstacles) noexcept { obstacles_ = std::move(obstacles); }
  /// @throws InvalidInput for another number of poses, and for one that is not rigid
  void setObstacles(std::vector<Obstacle> obstacles, const std::vector<Eigen::Isometry3d>& T_world_obstacle);

  /// T_world_body of each body.
  using Poses = std::vector<Kinematics::Pose>;

  Eigen::Vector3d centerOf(const Ball& ball, const Poses& poses) const { return poses[ball.body] * ball.center; }

  /// Whether all obstacles are certainly farther than the limit from a place.
  bool areBeyond(const Eigen::Vector3d& place, double limit) const
  {
    return std::all_of(obstacles_.begin(), obstacles_.end(),
                       [&](const Obstacle& obstacle) { return obstacle.isBeyond(place, limit); });
  }

  /// Returns how far uncertain joints may move the places of a ball that count (Ball::spread), seen from the body
  /// `rest`.
  double doubt(const Ball& ball, std::size_t rest) const;

  /// The gap between what a ball without parts holds, with its padding, and all obstacles, up to the limit.
  /// @param any for patches: any gap within the limit will do, not the least alone
  ObstacleGap toObstacles(const Ball& ball, const Poses& poses, double limit, bool any = false) const;

  /// Returns the gap of any record whose measured place is within the limit of the mesh that a ball holds; or no
  /// record.
  ObstacleGap anyOfMesh(const Ball& ball, const Poses& poses, double limit) const;

  /// The gap between the pieces of two balls, with their paddings. Beyond the limit the upper bound may be infinite.
  /// @param common the last body that both hang on (LinkPair)
  /// @param any for meshes: any gap within the limit will do, not the least alone
  Interval between(const Ball& a, const Ball& b, std::size_t common, const Poses& poses, double limit,
                   bool any = false) const;

  /// Returns a lower bound of how far the pieces of two balls are apart, by the hulls of meshes.
  /// @param least, enough the bound tells whether they are apart by more than each of these, no more
  double hullsApart(const Ball& a, const Ball& b, std::size_t common, const Poses& poses, double least,
                    double enough) const;

  /// @param for_certain names the record with the least upper bound; else the one with the least lower bound
  Meeting meetingOf(const Ball& ball, const ObstacleGap& gap, bool for_certain) const;
  Meeting meetingOf(const Ball& a, const Ball& b) const;

  /// Returns an upper bound of the error of computed gaps, at values of joints up to these.
  double error(const RobotState& largest) const;

  /// @param several what errors call it, with its number: a state, or a motion; null: it is the only one
  void requireState(const RobotState& state, const char* several = nullptr, std::size_t number = 0) const;

  const Robot robot;
  const WorldOptions options;
  const Kinematics kinematics;
  const Kinematics::Pose base;
  const Parts parts;

  const std::vector<Obstacle>& obstacles() const noexcept { return obstacles_; }

private:
  std::vector<Obstacle> obstacles_;
};

} // namespace pcl_bsh::robots
