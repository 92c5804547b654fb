// SPDX-License-Identifier: BSD-3-Clause
// The obstacle of a command line: a cloud or, where its file has faces, a surface.
#pragma once

#include <pcl_bsh/io/clouds/meshes/obstacle.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// Reads it, as a step of the program.
/// @param seconds that it took are added
/// @throws as io::readObstacle() does, whose last arguments these are
io::Obstacle loadObstacle(const std::filesystem::path& path, const io::SurfaceSettings& settings, double& seconds,
                          const io::ColumnNames& columns, io::CloudFacts* facts, unsigned threads);

/// What users should know of the obstacle, a line each, with the file's name.
std::vector<std::string> warningsOf(const io::Obstacle& obstacle, const std::filesystem::path& path);

} // namespace pcl_bsh::cli
