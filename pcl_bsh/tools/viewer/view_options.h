// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_view.
#pragma once

#include <pcl_bsh/tools/cli/obstacle_choice.h>
#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/question/question.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::viewer {

inline constexpr auto program = "pcl_bsh_view";

enum class Coloring { collision, distance, first_pose, height, rgb, intensity };

/// Where one looks from.
struct Camera {
  enum class Kind { slanted, top, front, side, colliding, given };

  Kind kind = Kind::slanted;
  std::array<double, 3> eye = {}, focus = {}, up = {0, 0, 1}; ///< of a given one
};

/// A plane; what lies on the side that its normal points to is not drawn.
struct Cut {
  std::array<double, 3> point = {}, normal = {};
};

struct Options : cli::SeveralObstacles {
  std::vector<std::filesystem::path> clouds;  ///< the first is the one asked about, the others are obstacles
  std::optional<std::filesystem::path> scene; ///< in place of clouds
  std::optional<std::filesystem::path> site;  ///< in place of clouds
  std::uint64_t budget = 10'000'000;          ///< points of a site that are drawn at once
  std::optional<std::filesystem::path> model;
  std::optional<std::filesystem::path> trajectory;
  Question question; ///< of the first cloud and each other one; the pose is the model's, without a trajectory
  std::optional<Coloring> color;
  std::optional<double> range; ///< distances up to here have colours; what collides has that of collisions
  std::optional<Cut> cut;      ///< of the first cloud
  std::optional<unsigned> level;
  unsigned step = 0; ///< of the trajectory or the scene
  bool voxels = false, cells = false, trace = false, closest = false, open_edges = false;
  unsigned beams = 0; ///< of the first cloud's scanner that are drawn
  std::string title;  ///< first line of the caption
  std::string unit;   ///< of lengths, for titles
  std::optional<std::filesystem::path> screenshot;
  int width = 1280, height = 960;
  Camera camera;
  std::optional<std::filesystem::path> export_to;
  cli::ReadChoice reading;
  cli::CommandFiles files; ///< except a scene's clouds
};

/// The options, checked one by one; none when only help was asked for. @throws cli::UsageError
std::optional<Options> parseOptions(int argc, char** argv);

} // namespace pcl_bsh::viewer
