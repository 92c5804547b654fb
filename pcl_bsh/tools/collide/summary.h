// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide_options.h"
#include "collide_report.h"

#include <pcl_bsh/io/reports/distance_report.h>

#include <optional>
#include <string>

namespace pcl_bsh::cli {

/// Tells people in a sentence what was found, after the warnings.
/// @param clashes how many there are, as io::clashCounts() tells it; empty where none were asked for
void summarise(const CollideOptions& options, const CollisionReport& report, const std::string& clashes,
               const std::optional<io::DistanceReport>& distances);

} // namespace pcl_bsh::cli
