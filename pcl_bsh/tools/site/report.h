// SPDX-License-Identifier: BSD-3-Clause
// What pcl_bsh_site collide is asked, and what its report says whatever the question.
#pragma once

#include "options.h"
#include "plan.h"
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/question/named_cloud.h>

#include <nlohmann/json.hpp>

#include <vector>

namespace pcl_bsh::cli {

using Json = nlohmann::ordered_json;

/// @param step that shows the progress; null on all ranks but the first
site::SiteRequest requestOf(const SiteOptions& options, Step* step);

/// What was asked.
Json beginReport(const site::Site& site, const SiteOptions& options);

/// @param key of the report
void putTiles(Json& report, const char* key, const site::TilesRead& tiles);

/// What a site meets along a path.
void putPassage(Json& report, const site::SitePassage& found, const Question& question);

/// A point of a site, by its name.
Json named(const site::Site& site, const site::SitePoint& point);

/// What the tiles have cost, and how long the run would take on other numbers of ranks.
void putPlan(Json& report, const std::vector<unsigned>& ranks, const MeasuredRun& run);

/// What site.json says of it; no tile is read.
NamedCloud namedSite(const site::Site& site);

} // namespace pcl_bsh::cli
