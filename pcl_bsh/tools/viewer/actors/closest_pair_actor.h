// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "actors.h"
#include <pcl_bsh/tools/viewer/content/view_content.h>

namespace pcl_bsh::viewer {

/// Adds a closest pair as a segment, with its distance.
void addClosestPair(PropGroup& group, const ClosestPair& closest, const std::string& unit);

} // namespace pcl_bsh::viewer
