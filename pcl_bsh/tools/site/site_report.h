// SPDX-License-Identifier: BSD-3-Clause
// The parts of the JSON report of pcl_bsh_site collide.
#pragma once

#include "output.h"
#include "plan.h"
#include "site_options.h"

#include <pcl_bsh/site/site_obstacles.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace pcl_bsh::cli {

using Json = nlohmann::ordered_json;

/// Begins a report with the question.
Json beginReport(const site::Site& site, const SiteOptions& options);

/// Adds how many tiles there are, were needed and were read. @param key of the report that gets these
void putTiles(Json& report, const char* key, const site::TilesRead& tiles);

/// Adds the answer, except the tiles. @param other the obstacle, where it is a site; else null
/// @param part of an obstacle in memory: "point" or "triangle"
void putAnswer(Json& report, const site::Site& site, const site::Site* other, const std::string& part,
               const SiteOptions& options, const site::SiteAnswer& found);

/// Adds the answers about each of several obstacles, and about pairs of them.
void putObstacles(Json& report, const site::Site& site, const ObstacleFiles& obstacles,
                  const site::SiteObstaclesAnswer& found, const std::vector<io::BetweenObstacles>& between);

/// Adds the cost of the tiles, and the time that the run would take on other numbers of ranks.
void putPlan(Json& report, const std::vector<unsigned>& ranks, const MeasuredRun& run);

} // namespace pcl_bsh::cli
