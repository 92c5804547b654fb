// SPDX-License-Identifier: BSD-3-Clause
// One of several obstacles, as a command line names it:
// NAME=FILE;pose=...;unit=...;clearance=...;solid=...;uncertainty=...;parts=...
#pragma once

#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>
#include <pcl_bsh/io/text/length_unit.h>
#include <pcl_bsh/question/obstacle_names.h>
#include <pcl_bsh/question/obstacles.h>
#include <pcl_bsh/question/uncertainty.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::cli {

/// An obstacle of a command line. Members without a value are those of the question.
struct ObstacleChoice {
  std::string name; ///< in lists and pages: the file's stem where none is given; of a part, PART or NAME/PART
  std::filesystem::path file;
  std::size_t part = 0;                                 ///< its number in `parts`
  std::shared_ptr<const io::MeshParts> parts = nullptr; ///< those of the file; null: the file is one obstacle
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::optional<io::LengthUnit> unit = {}; ///< of the file's lengths, in place of --obstacle-unit
  std::string pose_text = {};              ///< as typed, which may name a file
  std::optional<double> clearance = {};
  std::optional<bool> solid = {};
  std::optional<Uncertainty> uncertainty = {};
  bool asked = true; ///< whether it is compared with the input; else --previous tells of it

  /// The obstacle at its pose, with its own options.
  PlacedShape placed(Shape shape) const { return {std::move(shape), pose, clearance, solid, uncertainty}; }
};

/// The values of --obstacle. A text that as a whole names an existing file stands for it. With parts=true a file gives
/// an obstacle for each of its parts.
/// @param warnings gets those of poses and of parts
/// @throws UsageError for a word that is no option of an obstacle, a value that its option refuses, two obstacles of
///   one name; files::FileError for a file of a pose, and as readMeshParts() does
std::vector<ObstacleChoice> parseObstacles(const std::vector<std::string>& texts, std::vector<std::string>& warnings);

/// The options about several obstacles.
struct SeveralObstacles {
  std::vector<ObstacleChoice> obstacles; ///< none: there is a single one, without a name
  std::vector<std::string> ignored;      ///< pairs that are not compared, as typed
  std::vector<std::string> only;         ///< patterns of names that are asked about; empty: all are
  bool between = false;                  ///< whether they are compared with each other
  bool overlap = false;                  ///< whether the area of one inside another is told

  void addTo(CLI::App& app);
  void addObstaclesTo(CLI::App& app); ///< --obstacle alone

  /// Whether --obstacle is given.
  bool areGiven() const { return !texts_.empty(); }

  /// Reads the obstacles. @param first the file of one that comes before them; empty: none
  /// @throws as parseObstacles() and ignoredPairs() do; UsageError for a pattern that no name matches
  void readObstacles(const std::filesystem::path& first, std::vector<std::string>& warnings);

  /// @param solid whether obstacles without the option `solid` are solids. @param previous whether an earlier list is
  ///   given
  /// @throws UsageError for options that exclude or need others
  void requireConsistent(bool solid, bool previous) const;

  /// @throws UsageError where IgnoredPairs refuses them
  IgnoredPairs ignoredPairs() const;

private:
  std::vector<std::string> names() const;

  std::vector<std::string> texts_; ///< as typed
};

} // namespace pcl_bsh::cli
