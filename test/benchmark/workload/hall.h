// SPDX-License-Identifier: BSD-3-Clause
// Scenes of very uneven density: a hall seen by a spinning lidar, and a finely scanned statue in a coarse hall.
#pragma once

#include "scan_pair.h"

namespace pcl_bsh::bench {

/// Two sweeps of a 64-channel spinning lidar from two places in a hall of 60 x 30 x 10 with pillars and crates, some of
/// the crates moved in between. Points in firing order; density falls with the square of the range.
/// Spacing: the median over A.
ScanPair sweepPair(std::size_t count, std::uint64_t seed = 1);

/// A statue 2 tall holds half of the points, the hall about it the other half; B is the same sampled anew, with the
/// statue pushed aside by 0.05. Spacing: the statue's, some 30 times finer than the hall's.
ScanPair statueInHall(std::size_t count, std::uint64_t seed = 1);

} // namespace pcl_bsh::bench
