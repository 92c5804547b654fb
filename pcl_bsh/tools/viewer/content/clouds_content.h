// SPDX-License-Identifier: BSD-3-Clause
// A scan, and obstacles: some that do not move and a model that takes poses, or several with names, which a path moves
// together.
#pragma once

#include "field_content.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <set>
#include <string>

namespace pcl_bsh::viewer {

class CloudsContent final : public FieldContent {
public:
  /// @throws files::FileError, std::invalid_argument naming the file
  explicit CloudsContent(const Options& options);

  std::size_t steps() const override { return poses_.size(); }
  Eigen::Isometry3d poseOf(std::size_t cloud, std::size_t step) const override;
  bool moves(std::size_t cloud) const override { return cloud == model_ || (choiceOf(cloud) && steps() > 1); }

  /// The collisions that queries find; without a clearance, those of the scan's field `collision`, if any.
  StepCollisions collisions(std::size_t step) const override;
  std::string heading(const StepCollisions& collisions, std::size_t step) const override;
  MotionPaths paths(std::size_t step) const override;

  /// The distances that queries find; without a clearance, the scan's field `distance`.
  std::vector<float> distances(std::size_t step) const override;

  /// Without a clearance, distances to the nearest point of any obstacle. Without obstacles the scan's field
  /// `distance`, where it holds those of free points. With a clearance, none.
  std::vector<double> allDistances(std::size_t step) const override;

  /// The first poses that queries find; without a clearance, the scan's field `first_pose`. Asked once, then kept.
  std::vector<std::int32_t> firstPoses() const override;

  /// For the scan's parts: the distance to the nearest point of any obstacle, and the first pose.
  std::string details(std::size_t cloud, std::uint32_t part, std::size_t step) const override;
  std::vector<Trace> traces(std::size_t step) const override;
  std::vector<std::array<Eigen::Vector3d, 2>> beams() const override;

private:
  Placed placed(std::size_t cloud, std::size_t step) const
  {
    return {*viewed_clouds_[cloud].hierarchy, poseOf(cloud, step)};
  }
  /// Returns how the command line names the obstacle; null of a cloud without a name.
  const cli::ObstacleChoice* choiceOf(std::size_t cloud) const
  {
    return cloud > 0 && !options_.obstacles.empty() ? &options_.obstacles[cloud - 1] : nullptr;
  }
  std::optional<double> clearanceOf(std::size_t other) const;
  void loadNamed(const io::CloudFacts& of_scan);
  std::vector<Eigen::Isometry3d> pathOf(std::size_t cloud) const; ///< all its poses, one after another
  void warnOfQuestions() const;                                   ///< of the scan and each other cloud

  /// Asks the scan and another cloud at a step. @param input part of the scan; null: all of it
  Answer asked(std::size_t other, std::size_t step, Question question, Shape* input = nullptr) const;
  std::optional<ClosestPair> closest(std::size_t other, std::size_t step) const;
  std::optional<ClosestPair> closest(std::size_t step) const;
  std::optional<double> distanceOf(std::uint32_t part, std::size_t step) const;

  mutable std::vector<Shape> shapes_;    ///< of the viewed clouds, with what is kept of them
  mutable std::set<std::string> hollow_; ///< warnings that were told
  ScanOrigins origins_;                  ///< of the scan
  mutable Shape seen_from_;              ///< the scan with its fields, for questions with `seen`
  std::optional<std::size_t> model_;
  std::vector<Eigen::Isometry3d> poses_;
  mutable std::optional<std::vector<std::int32_t>> first_poses_;
};

} // namespace pcl_bsh::viewer
