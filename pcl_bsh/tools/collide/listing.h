// SPDX-License-Identifier: BSD-3-Clause
// The list of clashes that a comparison writes, and the earlier one that it is compared with.
#pragma once

#include "collide_options.h"
#include "collide_report.h"

#include <pcl_bsh/io/reports/clash_report.h>

#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The lists of --previous, none without it. @param warnings gets what requireComparable() tells
/// @throws as io::readClashLists() and io::requireComparable() do
std::vector<io::ClashList> readEarlier(const CollideOptions& options, const Question& question,
                                       std::vector<std::string>& warnings);

/// Writes all files of --clashes, as a step of the program. @param hierarchies of the report's obstacles
/// @return how many clashes there are, in words
std::string listClashes(const CollideOptions& options, const SphereHierarchy& a,
                        const std::vector<const SphereHierarchy*>& hierarchies,
                        const std::vector<io::ClashList>& earlier, CollisionReport& report);

} // namespace pcl_bsh::cli
