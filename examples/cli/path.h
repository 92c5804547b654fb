// SPDX-License-Identifier: BSD-3-Clause
// How the obstacle moves, as users write it: a file of poses, or a straight run from one pose to another.
#pragma once

#include "pose.h"
#include "program.h"

#include <pcl_bsh/filters/pose_files/pose_file.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The poses of a straight run of so many steps: one more than steps, both ends among them. Translation is linear,
/// rotation spherically so. @throws UsageError when they are half a turn apart: either way round is as short.
inline std::vector<Eigen::Isometry3d> straightRun(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
                                                  std::size_t steps)
{
  std::vector<Eigen::Isometry3d> poses = {from};
  try {
    for (std::size_t i = 1; i < steps; ++i) {
      poses.push_back(poseBetween(from, to, static_cast<double>(i) / static_cast<double>(steps)));
    }
  }
  catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--to: ") + error.what());
  }
  poses.push_back(to);
  return poses;
}

/// The options --trajectory, --from, --to, --steps and --swept, as typed.
struct PathOptions {
  std::string file, from, to, steps, swept;

  void addTo(CLI::App& app)
  {
    app.add_option("--trajectory", file,
                   "poses of OBSTACLE, one a line: 12 or 16 numbers of a matrix, row by\n"
                   "row, or time tx ty tz qx qy qz qw; instead of --pose. OUTPUT gets the\n"
                   "fields distance, first_pose and closest_pose beside collision")
        ->type_name("FILE");
    app.add_option("--from", from, "a straight run instead: its first pose, as --pose has it")->type_name("POSE");
    app.add_option("--to", to, "its last pose")->type_name("POSE");
    app.add_option("--steps", steps, "number of steps from the first to the last")->type_name("N");
    app.add_option("--swept", swept,
                   "the motion between poses counts too: points within D of it collide,\n"
                   "points beyond D + TOL do not; TOL > 0, in the clouds' unit")
        ->type_name("TOL");
  }

  bool isStraight() const { return !from.empty() || !to.empty() || !steps.empty(); }

  /// @param pose what stands behind --pose
  void requireSense(const std::string& pose) const
  {
    const bool moves = !file.empty() || isStraight();
    if (!file.empty() && isStraight()) throw UsageError("--from: --trajectory is given too: give one of them");
    if (!pose.empty() && moves) throw UsageError("--pose: a path is given too: give one of them");
    if (isStraight() && (from.empty() || to.empty() || steps.empty())) {
      throw UsageError("--from: a straight run is not complete: give --from, --to and --steps");
    }
    if (!swept.empty() && !moves)
      throw UsageError("--swept: nothing moves: give --trajectory, or --from, --to, --steps");
  }
};

} // namespace pcl_bsh::cli
