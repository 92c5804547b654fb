// SPDX-License-Identifier: BSD-3-Clause
// The obstacle of a command line: a cloud or, where its file has faces, a surface.
#pragma once

#include "obstacle_choice.h"
#include "reading.h"

#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/question/question.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// Reads an obstacle, as a step of the program.
/// @param seconds the time that it took is added
/// @param reading, facts, threads as io::readObstacle() takes them. @throws as io::readObstacle() does
io::Obstacle loadObstacle(const std::filesystem::path& path, const io::SurfaceSettings& settings, double& seconds,
                          const io::ReadSettings& reading, io::CloudFacts* facts, unsigned threads);

/// An obstacle, and the facts that its file states.
struct LoadedObstacle {
  io::Obstacle obstacle;
  io::CloudFacts facts;
};

/// How obstacles are loaded.
struct Loading {
  const ReadChoice& reading;
  std::optional<io::LengthUnit> input_unit; ///< as the input was read
  bool shows = true;                        ///< each file is a step of the program
  bool unasked = false;                     ///< also obstacles that are not asked about
};

/// Loads the obstacles that are asked about; the others are left empty. Each file with parts is read once.
/// @param seconds the time that it took is added. @param told called for each file, once it is loaded; may be null
/// @throws as io::readObstacle(), io::readMesh() and io::obstaclesOf() do; UsageError where a unit is not known
std::vector<LoadedObstacle>
loadObstacles(const std::vector<ObstacleChoice>& choices, const Question& question, const Loading& loading,
              double& seconds, const std::function<void(const ObstacleChoice&, const io::CloudFacts&)>& told = nullptr);

/// Fails unless a file can hold the obstacle and a flag for each of its points or triangles. Surfaces need a .ply.
/// @throws files::FileError; std::invalid_argument for a cloud whose field `collision` is of another type
void requireWritableFlags(const std::filesystem::path& file, const io::Obstacle& obstacle);

/// Writes the obstacle in its own frame, with the flags as a field `collision`. Throws as requireWritableFlags() does.
/// @param flags one for each record of the obstacle's view
void writeFlags(const std::filesystem::path& file, const io::Obstacle& obstacle, const std::vector<Verdict>& flags,
                const io::CloudFacts& facts);

/// Warnings about the obstacle, a line each, with the file's name.
std::vector<std::string> warningsOf(const io::Obstacle& obstacle, const std::filesystem::path& path);

} // namespace pcl_bsh::cli
