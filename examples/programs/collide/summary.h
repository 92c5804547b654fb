// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options.h"
#include "report.h"

#include <pcl_bsh/filters/reports/clash_report.h>
#include <pcl_bsh/filters/reports/distance_report.h>

#include <optional>
#include <vector>

namespace pcl_bsh::cli {

/// Tells people in a sentence what was found, after the warnings.
void summarise(const CollideOptions& options, const CollisionReport& report, const std::vector<Clash>& clashes,
               const std::optional<io::DistanceReport>& distances);

} // namespace pcl_bsh::cli
