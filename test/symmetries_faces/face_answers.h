// SPDX-License-Identifier: BSD-3-Clause
// Answers of PCL's classes, pipelines, sites and programs about an instance, for the symmetries of the queries. Clouds
// have neither radii nor uncertainties; a's frame is the one that poses are given in.
#pragma once

#include "symmetries/answers.h"

#include <filesystem>

namespace pcl_bsh::symmetries {

/// By CollisionFilter, DistanceFilter and MeshCollisionFilter.
Answers askFilters(const Instance& instance);

/// By the stages filters.bsh_flag and filters.bsh_distance, of clouds in memory.
Answers askPipelines(const Instance& instance);

/// Asks about a as a site, in a new folder within `folder`.
/// @param tile_points at most in a tile
Answers askSite(const Instance& instance, const std::filesystem::path& folder, std::uint64_t tile_points);

/// By pcl_bsh_collide, with files in `folder`. @throws std::runtime_error when it fails
Answers askProgram(const Instance& instance, const std::filesystem::path& folder);

} // namespace pcl_bsh::symmetries
