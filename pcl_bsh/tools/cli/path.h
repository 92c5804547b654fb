// SPDX-License-Identifier: BSD-3-Clause
// How the obstacle stands or moves, as users write it: a pose, a file of poses, or a straight run from one pose to
// another.
#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The pose that the value of an option stands for: six numbers x,y,z,roll,pitch,yaw or the name of a file for
/// io::readPose(). A matrix with |R'R - I| from 1e-6 to 1e-4, as few printed digits leave it, stands for its nearest
/// rotation; `warnings` gets a line then, and for angles of more than two turns.
/// @throws UsageError when it is neither, files::FileError as readPose() does
Eigen::Isometry3d parsePose(const std::string& option, const std::string& text, std::vector<std::string>& warnings);

/// The values of --pose, --place and --pairs.
struct PoseOptions {
  std::string pose, place;     ///< as typed
  std::filesystem::path pairs; ///< which pcl_bsh::io::readPoseFit() reads, once units are known

  void addTo(CLI::App& app);

  bool given() const { return !pose.empty() || !place.empty() || !pairs.empty(); }
  std::string option() const { return !place.empty() ? "--place" : !pairs.empty() ? "--pairs" : "--pose"; }

  /// The pose of --pose or --place; none without. @throws UsageError where two are given, and as parsePose() does
  std::optional<Eigen::Isometry3d> read(std::vector<std::string>& warnings) const;
};

/// The values of --trajectory, --from, --to, --steps and --swept.
struct PathOptions {
  std::filesystem::path file;
  std::string from, to; ///< as typed: numbers or files
  std::optional<unsigned> steps;
  std::optional<double> swept;

  void addTo(CLI::App& app);

  bool isStraight() const { return !from.empty() || !to.empty() || steps.has_value(); }

  /// @param pose the option that gives a pose, or empty. @throws UsageError for options that contradict each other
  void requireConsistent(const std::string& pose) const;

  /// The poses of the straight run: one more than steps, both ends among them. Translation is linear, rotation
  /// spherically so. @throws UsageError when the ends are half a turn apart: either way round is as short
  std::vector<Eigen::Isometry3d> straightRun(std::vector<std::string>& warnings) const;
};

} // namespace pcl_bsh::cli
