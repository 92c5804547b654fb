// SPDX-License-Identifier: BSD-3-Clause
// The obstacle of a command line: a cloud or, where its file has faces, a surface.
#pragma once

#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/query/result.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// Reads it, as a step of the program.
/// @param seconds that it took are added
/// @throws as io::readObstacle() does, whose last arguments these are
io::Obstacle loadObstacle(const std::filesystem::path& path, const io::SurfaceSettings& settings, double& seconds,
                          const io::ReadSettings& reading, io::CloudFacts* facts, unsigned threads);

/// Reads a file's parts, each an obstacle, as a step of the program. The first has the remarks about the file.
/// @param seconds that it took are added
/// @throws as io::readMesh(), whose last arguments these are, and io::obstaclesOf() do
std::vector<io::Obstacle> loadParts(const io::MeshParts& parts, const io::SurfaceSettings& settings, double& seconds,
                                    const io::ReadSettings& reading, io::CloudFacts& facts, unsigned threads);

/// Fails unless a file can hold the obstacle and which of its points, or of its triangles, collide. Surfaces are .ply.
/// @throws files::FileError; std::invalid_argument for a cloud whose field `collision` is of another type
void requireWritableFlags(const std::filesystem::path& file, const io::Obstacle& obstacle);

/// Writes them, where the obstacle's own file has it, with a field `collision`. Throws as requireWritableFlags() does.
/// @param flags one for each record of its view
void writeFlags(const std::filesystem::path& file, const io::Obstacle& obstacle, const std::vector<Verdict>& flags,
                const io::CloudFacts& facts);

/// Warnings about the obstacle, a line each, with the file's name.
std::vector<std::string> warningsOf(const io::Obstacle& obstacle, const std::filesystem::path& path);

} // namespace pcl_bsh::cli
