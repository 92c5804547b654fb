// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_collide.
#pragma once

#include <pcl_bsh/tools/cli/clash_options.h>
#include <pcl_bsh/tools/cli/obstacle_choice.h>
#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/question/question.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto collide_program = "pcl_bsh_collide";

enum class Keep { flagged, colliding, free };

struct CollideOptions : SeveralObstacles, ClashOptions {
  std::filesystem::path input;
  std::filesystem::path obstacle; ///< where there are no `obstacles`
  std::filesystem::path output;
  std::optional<std::filesystem::path> obstacle_out;
  std::optional<std::filesystem::path> report;
  Keep keep = Keep::flagged;
  Question question;                ///< its path: a straight run, or that of the trajectory, once it is read
  std::filesystem::path trajectory; ///< a file of poses, or empty
  std::filesystem::path pairs;      ///< a file of pairs of places that the pose is to fit, or empty
  std::filesystem::path poses_out;  ///< for the poses that are asked about, or empty
  bool distances = false;           ///< of every point
  std::optional<std::filesystem::path> distance_page;
  ReadChoice reading;
  std::vector<std::string> warnings;       ///< of the options themselves
  std::vector<std::string> names_of_poses; ///< the options that gave poses, as advice() takes them
  CommandFiles files;                      ///< all that are read or written

  bool moves() const { return question.path.has_value() || !trajectory.empty(); }

  /// Whether the output gets distances and poses: along a path, unless the accuracy stops early and cannot tell them.
  bool tellsContacts() const { return moves() && !question.accuracy.stopsEarly(); }
};

/// The options, checked; none when only help was asked for. @throws UsageError, files::FileError of pose files
std::optional<CollideOptions> parseCollideOptions(int argc, char** argv);

} // namespace pcl_bsh::cli
