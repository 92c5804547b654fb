// SPDX-License-Identifier: BSD-3-Clause
// Two overlapping terrain scans: the same hills seen twice, shifted, and changed in part between the two.
#pragma once

#include "scan_pair.h"

namespace pcl_bsh::bench {

/// About `count` points each (a square number of rows and columns), spacing 1 with jitter, flown in rows; B covers the
/// area shifted by 30 % of the extent, sampled anew, and a quarter of the overlap has been raised by 3, 12 or 40.
ScanPair terrainPair(std::size_t count, std::uint64_t seed = 1);

} // namespace pcl_bsh::bench
