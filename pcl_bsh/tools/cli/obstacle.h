// SPDX-License-Identifier: BSD-3-Clause
// The obstacle of a command line: a cloud or, where its file has faces, a surface.
#pragma once

#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/query/accuracy.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// --surface-tolerance and --vertices-only, of which one is given.
/// @param tolerance finite and > 0, or none
void addSurfaceOptions(CLI::App& app, std::optional<double>& tolerance, bool& vertices_only);

/// Reads it, as a step of the program.
/// @param clearance of the query. @param seconds that it took are added
/// @throws as io::readObstacle() does, whose last arguments these are
io::Obstacle loadObstacle(const std::filesystem::path& path, const io::SurfaceSettings& settings, double clearance,
                          double& seconds, const io::ColumnNames& columns, io::CloudFacts* facts, unsigned threads);

/// What users should know of the obstacle, a line each, with the file's name.
std::vector<std::string> warningsOf(const io::Obstacle& obstacle, const std::filesystem::path& path);

/// A field of sigmas is one of points. @throws std::invalid_argument for one of a surface
void requireLength(const io::Obstacle& obstacle, const std::filesystem::path& path, const Uncertainty& uncertainty);

/// Whose tolerance comes on top of a surface's, as io::promiseOf() takes it; empty: none.
std::string besideSurface(const Accuracy& accuracy, bool swept);

} // namespace pcl_bsh::cli
