// SPDX-License-Identifier: BSD-3-Clause
// What there is to see, without a picture: clouds, their hierarchies and poses, and what collides at each step.
#pragma once

#include "options.h"
#include "thing.h"

#include <pcl_bsh/collision/trace.h>

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::view {

/// The closest pair, in the world.
struct Closest {
  Eigen::Vector3d a, b;
  double distance = 0.0;
};

/// What collides at one step.
struct Findings {
  bool known = false;                           ///< whether anything was asked
  std::vector<std::vector<std::uint8_t>> flags; ///< of each thing, 1 = collides, per record; empty: none do
  std::size_t colliding = 0;                    ///< points of what was asked about
  std::optional<Closest> closest;
};

/// Ways that things take, each drawn as a line.
struct Ways {
  std::string name;
  std::vector<std::vector<Eigen::Isometry3d>> poses;
};

/// How the query for any collision between two things went.
struct Trace {
  std::size_t a = 0, b = 0; ///< numbers of things
  CollisionTrace trace;
};

class World {
public:
  virtual ~World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const Options& options() const { return options_; }
  const std::vector<Thing>& things() const { return things_; }
  const Thing& scan() const { return things_.front(); } ///< the one that fields and values are shown of

  virtual std::string name() const = 0;     ///< of the window
  virtual std::size_t steps() const = 0;    ///< at least one
  virtual const char* stepName() const = 0; ///< what steps are
  virtual Eigen::Isometry3d poseOf(std::size_t thing, std::size_t step) const = 0;
  virtual bool moves(std::size_t thing) const = 0;

  /// Points that move in their own frame stand where they are at this step, once its findings() were asked for.
  virtual bool deforms(std::size_t /*thing*/) const { return false; }
  virtual Findings findings(std::size_t step) const = 0;

  /// Lines that say what is seen.
  virtual std::string heading(const Findings& findings, std::size_t step) const = 0;
  virtual Ways ways(std::size_t step) const = 0;

  // Of the scan, per record; empty where that is not known.
  virtual std::vector<float> distances(std::size_t /*step*/) const { return {}; } ///< NaN where free
  virtual std::vector<std::int32_t> firstPoses() const { return {}; }             ///< -1 where always free

  /// More about a point, to follow what it is; or empty.
  virtual std::string details(std::size_t /*thing*/, std::uint32_t /*record*/, std::size_t /*step*/) const
  {
    return {};
  }
  virtual std::vector<Trace> traces(std::size_t /*step*/) const { return {}; }

protected:
  explicit World(Options options) : options_(std::move(options)) {}

  Options options_;
  std::vector<Thing> things_;
};

/// What the options name, loaded and indexed. @throws io::CloudFileError, io::JsonError, std::invalid_argument naming
/// the file
std::unique_ptr<World> makeWorld(const Options& options);

} // namespace pcl_bsh::view
