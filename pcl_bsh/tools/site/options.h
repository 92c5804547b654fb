// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_site.
#pragma once

#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/text/column_names.h>
#include <pcl_bsh/query/accuracy.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto site_program = "pcl_bsh_site";

enum class SiteCommand : std::uint8_t { make, info, validate, write, collide };

/// What `collide` asks.
enum class SiteQuestion : std::uint8_t { any, flags, closest, distances, path };

struct SiteOptions {
  SiteCommand command = SiteCommand::info;
  std::vector<std::filesystem::path> clouds; ///< to make a site of
  std::filesystem::path site;
  std::filesystem::path
      out; ///< of `write`: a .pcd or .pvtp file, or a folder for the sources; of `collide`: a site, or none
  std::uint64_t memory = std::uint64_t{2} << 30;
  std::uint64_t tile_points = 4'000'000;
  io::SurfaceSettings surface; ///< of `make`, whether meshes are their vertices; of `collide`, of the obstacle

  bool json = false; ///< of `info` and `validate`: what they tell

  // of `collide`
  /// Whether the obstacle is a site, too: a folder.
  bool obstacleIsSite() const { return std::filesystem::is_directory(obstacle); }
  SiteQuestion question = SiteQuestion::flags;
  std::filesystem::path obstacle, trajectory, report;
  std::filesystem::path obstacle_out;         ///< the obstacle with its flags, a cloud or a site as it, or none
  std::vector<std::filesystem::path> clashes; ///< files for the clash report, .json .csv .html
  double cluster_distance = 0;                ///< 0: from clearance and spacing
  std::optional<std::filesystem::path> previous;
  std::string unit;    ///< of the clouds, for the clash report; empty: not known
  bool resume = false; ///< go on with what the same question has left in `out`
  double clearance = 0.0;
  Accuracy accuracy;
  Uncertainty uncertainty, obstacle_uncertainty;
  std::optional<double> swept;
  double max_distance = std::numeric_limits<double>::infinity();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  unsigned threads = 1, make_threads = 0;
  std::vector<unsigned> plan; ///< numbers of ranks whose time is predicted
  std::vector<std::string> warnings;
  io::ColumnChoice columns; ///< of `make` and `collide`
  CommandFiles files;       ///< that `collide` reads and writes
};

/// The options, checked; none when only help was asked for. @throws UsageError
std::optional<SiteOptions> parseSiteOptions(int argc, char** argv);

} // namespace pcl_bsh::cli
