// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_site.
#pragma once

#include <pcl_bsh/tools/cli/clash_options.h>
#include <pcl_bsh/tools/cli/obstacle_choice.h>
#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/question/question.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto site_program = "pcl_bsh_site";

enum class SiteCommand : std::uint8_t { make, info, validate, write, collide };

struct SiteOptions : SeveralObstacles, ClashOptions {
  SiteCommand command = SiteCommand::info;
  std::vector<std::filesystem::path> clouds; ///< to make a site of
  std::filesystem::path site;
  /// For `write` a .pcd or .pvtp file, or a folder for the sources; for `collide` a site, or none.
  std::filesystem::path out;
  std::uint64_t memory = std::uint64_t{2} << 30;
  std::uint64_t tile_points = 4'000'000;
  bool json = false; ///< of `info` and `validate`: print JSON

  // of `collide`
  /// The obstacles that are in memory: several, or the only one, which has no name.
  std::vector<ObstacleChoice> choices() const
  {
    return obstacles.empty() ? std::vector<ObstacleChoice>{{"", obstacle}} : obstacles;
  }
  /// Whether the obstacle is a site, too: a folder.
  bool obstacleIsSite() const { return std::filesystem::is_directory(obstacle); }
  /// The question. Its path is that of `trajectory`, once that is read. Its threads are those of each process. For
  /// `make`, it states whether meshes are their vertices.
  Question question;
  /// Whether the answer is that of a path, also with a single pose.
  bool alongPath() const { return question.path || question.wanted.contacts; }
  std::filesystem::path obstacle, trajectory, report;
  std::filesystem::path obstacle_out; ///< obstacle with flags: a site if that is one, else a file; or none
  bool resume = false;                ///< go on with what the same question has left in `out`
  unsigned make_threads = 0;
  std::vector<unsigned> plan; ///< numbers of ranks whose time is predicted
  std::vector<std::string> warnings;
  ReadChoice reading;                                 ///< of `make` and `collide`
  std::optional<io::LengthUnit> clouds_unit, to_unit; ///< of `make`
  CommandFiles files;                                 ///< that `collide` reads and writes
};

/// The options, checked; none when only help was asked for. @throws UsageError
std::optional<SiteOptions> parseSiteOptions(int argc, char** argv);

} // namespace pcl_bsh::cli
