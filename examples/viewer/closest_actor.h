// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "actors.h"
#include "world.h"

namespace pcl_bsh::view {

/// Adds a closest pair as a segment, with its distance.
void addClosest(PropGroup& group, const Closest& closest, const std::string& unit);

} // namespace pcl_bsh::view
