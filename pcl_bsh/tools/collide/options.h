// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_collide.
#pragma once

#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto collide_program = "pcl_bsh_collide";

enum class Keep { flagged, colliding, free };

/// What is asked about the distance of every point.
struct DistanceOptions {
  double most = std::numeric_limits<double>::infinity(); ///< greater ones are not told
  std::optional<std::filesystem::path> page;
};

struct CollideOptions {
  std::filesystem::path input;
  std::filesystem::path obstacle;
  std::filesystem::path output;
  std::optional<std::filesystem::path> report;
  Keep keep = Keep::flagged;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_input_obstacle
  std::filesystem::path trajectory;                       ///< a file of such poses, or empty
  std::vector<Eigen::Isometry3d> path;                    ///< a straight run of them, or empty
  std::optional<double> swept;
  std::vector<std::filesystem::path> clashes; ///< files for the clash report, .json .csv .html
  double cluster_distance = 0;                ///< 0: from clearance and spacing
  std::optional<std::filesystem::path> previous;
  std::optional<DistanceOptions> distances;
  std::string unit; ///< of the clouds, for reports; empty: not known
  double clearance = 0.0;
  bool asks_collisions = true; ///< a clearance was given
  unsigned threads = 0;        ///< all of the machine's
  Accuracy accuracy;
  Uncertainty input_uncertainty, obstacle_uncertainty;
  io::SurfaceSettings surface;
  io::ColumnChoice columns;
  bool density = false;
  double widest_gap = 0;             ///< 0: as the obstacle's spacing suggests
  std::vector<std::string> warnings; ///< of the options themselves
  CommandFiles files;                ///< all that are read or written

  bool moves() const { return !trajectory.empty() || !path.empty(); }
};

/// The options, checked; none when only help was asked for. @throws UsageError, files::FileError of pose files
std::optional<CollideOptions> parseCollideOptions(int argc, char** argv);

} // namespace pcl_bsh::cli
