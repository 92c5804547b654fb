// SPDX-License-Identifier: BSD-3-Clause
// Warnings about clouds that a robot moves among. warnings.h has those about two clouds.
#pragma once

#include <pcl_bsh/question/warnings/warnings.h>

#include <optional>
#include <string>

namespace pcl_bsh {

/// Warns where a link may slip through holes between the points of an obstacle. Needs its spacing.
/// @param clearance with the radii of its points
PCL_BSH_EXPORT_INTERNAL std::optional<Warning> warningOfHoles(const NamedCloud& obstacle, const std::string& robot,
                                                              double clearance);

} // namespace pcl_bsh
