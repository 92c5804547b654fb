// SPDX-License-Identifier: BSD-3-Clause
// One of several obstacles, as a command line names it:
// NAME=FILE;pose=...;unit=...;clearance=...;solid=...;uncertainty=...;parts=...
#pragma once

#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>
#include <pcl_bsh/io/text/length_unit.h>
#include <pcl_bsh/question/uncertainty.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// An obstacle of a command line. Members without a value are those of the question.
struct ObstacleChoice {
  std::string name; ///< that lists and pages tell: the file's stem where none is given; of a part, PART or NAME/PART
  std::filesystem::path file;
  std::size_t part = 0;                                 ///< of `parts`
  std::shared_ptr<const io::MeshParts> parts = nullptr; ///< of the file; null: it is one obstacle
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::optional<io::LengthUnit> unit = {}; ///< of the file's lengths, in place of --obstacle-unit
  std::string pose_text = {};              ///< as typed, which may name a file
  std::optional<double> clearance = {};
  std::optional<bool> solid = {};
  std::optional<Uncertainty> uncertainty = {};
};

/// The values of --obstacle. A text that is the name of a file as a whole is that file. A file in parts gives one for
/// each of them.
/// @param warnings gets those of poses and of parts
/// @throws UsageError for a word that is no option of an obstacle, a value that its option refuses, two obstacles of
///   one name; files::FileError for a file of a pose, and as readMeshParts() does
std::vector<ObstacleChoice> parseObstacles(const std::vector<std::string>& texts, std::vector<std::string>& warnings);

} // namespace pcl_bsh::cli
