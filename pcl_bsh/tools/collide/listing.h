// SPDX-License-Identifier: BSD-3-Clause
// The list of clashes that a comparison writes, and the earlier one that it is compared with.
#pragma once

#include "collide_options.h"
#include "collide_report.h"

#include <pcl_bsh/io/reports/compared_obstacles.h>

#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// With the list of --previous. @param warnings gets those of the comparison
/// @throws as io::ClashListing::readEarlier() does
io::ClashListing listingOf(const CollideOptions& options, const Question& question, std::vector<std::string>& warnings);

/// Writes all files of --clashes, as a step of the program. @param hierarchies of the report's obstacles
/// @return how many clashes there are, in words
std::string listClashes(const CollideOptions& options, const SphereHierarchy& a,
                        const std::vector<const SphereHierarchy*>& hierarchies, io::ClashListing& listing,
                        CollisionReport& report);

} // namespace pcl_bsh::cli
