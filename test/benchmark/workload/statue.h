// SPDX-License-Identifier: BSD-3-Clause
// Closed bumpy surfaces with noise, like scanned statues.
#pragma once

#include "points.h"

#include <array>

namespace pcl_bsh::bench {

/// `count` points on a closed surface about the origin, some 2 units tall and 1.2 wide, with bumps of many sizes;
/// roughly uniform spacing, noise of 5 % of it, in scan order (rows). Different seeds, different statues.
Points statue(std::size_t count, std::uint64_t seed);

/// The place of its surface, without noise, in a direction from the origin. @pre not 0
std::array<double, 3> onStatue(std::array<double, 3> direction, std::uint64_t seed);

} // namespace pcl_bsh::bench
