// SPDX-License-Identifier: BSD-3-Clause
// What there is to see, without a picture: clouds, their hierarchies and poses, and what collides.
#pragma once

#include "options.h"

#include <pcl_bsh/query/collide.h>
#include <pcl_bsh/query/trace.h>
#include <pcl_bsh/query/trajectory.h>

#include <pcl/PCLPointCloud2.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::view {

/// A cloud and its index.
struct Thing {
  std::filesystem::path file;
  pcl::PCLPointCloud2 cloud;
  std::unique_ptr<SphereHierarchy> hierarchy;

  const PointsView& points() const { return hierarchy->view(); }

  /// A field's values, one per record; none where the cloud has no such field, or one of several values.
  std::optional<std::vector<float>> field(const std::string& name) const;

  /// Red, green, blue, per record; none where the cloud has no colours.
  std::optional<std::vector<std::array<unsigned char, 3>>> colors() const;
};

/// The closest pair, in the world.
struct Closest {
  Eigen::Vector3d a, b;
  double distance = 0.0;
};

/// What collides at one step. Vectors of flags have one entry per record.
struct Findings {
  bool known = false;                           ///< whether anything was asked
  std::vector<std::uint8_t> scan;               ///< 1 = collides
  std::vector<std::vector<std::uint8_t>> other; ///< of each other thing
  std::size_t colliding = 0;                    ///< points of the scan
  std::optional<Closest> closest;
};

class World {
public:
  /// Loads and indexes. @throws io::CloudFileError, std::invalid_argument naming the file
  explicit World(const Options& options);

  const Options& options() const { return options_; }
  const Thing& scan() const { return things_.front(); }
  const std::vector<Thing>& things() const { return things_; } ///< the scan, obstacles, the model
  std::optional<std::size_t> model() const { return model_; }  ///< its number among the things
  const std::vector<Eigen::Isometry3d>& poses() const { return poses_; }
  std::size_t steps() const { return poses_.size(); } ///< at least one
  Eigen::Isometry3d poseOf(std::size_t thing, std::size_t step) const;

  /// Asked of the queries; without a clearance, read from the scan's field `collision`, if any.
  Findings findings(std::size_t step) const;

  /// Exact, to the nearest point of any obstacle. @return none when there is no obstacle
  std::optional<double> distanceOf(std::uint32_t record, std::size_t step) const;

  /// Per record, NaN where free; or the scan's field `distance`.
  std::vector<float> distances(std::size_t step) const;

  /// Per record the first pose at which it collides, or -1; or the scan's field `first_pose`. Asked once, then kept.
  const std::vector<std::int32_t>& firstPoses() const;
  bool knowsFirstPoses() const { return first_poses_.has_value(); }

  /// How the query for any collision between the scan and an obstacle went.
  CollisionTrace trace(std::size_t obstacle, std::size_t step) const;

private:
  Placed placed(std::size_t thing, std::size_t step) const { return {*things_[thing].hierarchy, poseOf(thing, step)}; }
  CollisionRequest request() const;
  TrajectoryRequest along() const;

  Options options_;
  std::vector<Thing> things_;
  std::optional<std::size_t> model_;
  std::vector<Eigen::Isometry3d> poses_;
  mutable std::optional<std::vector<std::int32_t>> first_poses_;
};

} // namespace pcl_bsh::view
