// SPDX-License-Identifier: BSD-3-Clause
// How the obstacle moves, as users write it: a file of poses, or a straight run from one pose to another.
#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The values of --trajectory, --from, --to, --steps and --swept.
struct PathOptions {
  std::filesystem::path file;
  std::string from, to; ///< as typed: numbers or files
  std::optional<unsigned> steps;
  std::optional<double> swept;

  void addTo(CLI::App& app);

  bool isStraight() const { return !from.empty() || !to.empty() || steps.has_value(); }

  /// @param has_pose whether --pose is given. @throws UsageError for options that contradict each other
  void requireConsistent(bool has_pose) const;

  /// The poses of the straight run: one more than steps, both ends among them. Translation is linear, rotation
  /// spherically so. @throws UsageError when the ends are half a turn apart: either way round is as short
  std::vector<Eigen::Isometry3d> straightRun(std::vector<std::string>& warnings) const;
};

} // namespace pcl_bsh::cli
