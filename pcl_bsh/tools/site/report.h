// SPDX-License-Identifier: BSD-3-Clause
// What pcl_bsh_site collide is asked, and what its report says whatever the question.
#pragma once

#include "options.h"
#include "plan.h"
#include <pcl_bsh/tools/cli/step.h>

#include <nlohmann/json.hpp>

#include <vector>

namespace pcl_bsh::cli {

using Json = nlohmann::ordered_json;

/// @param step that shows the progress; null on all ranks but the first
site::SiteRequest requestOf(const SiteOptions& options, Step* step);

/// What was asked.
Json beginReport(const site::Site& site, const SiteOptions& options);

/// NaN and infinity have no place in JSON.
Json orNull(double number);

/// @param key of the report
void putTiles(Json& report, const char* key, const site::TilesRead& tiles);

/// The tiles of the site asked about, and what they have cost.
void put(Json& report, const site::TilesRead& tiles, MeasuredRun& run);

/// What a site meets along a path of so many poses.
void putPassage(Json& report, const site::SitePassage& found, std::size_t poses, const SiteOptions& options);

/// A point of a site, by its name.
Json named(const site::Site& site, const site::SitePoint& point);

/// What the tiles have cost, and how long the run would take on other numbers of ranks.
void putPlan(Json& report, const std::vector<unsigned>& ranks, const MeasuredRun& run);

} // namespace pcl_bsh::cli
