// SPDX-License-Identifier: BSD-3-Clause
// Two clouds in one frame, to be compared.
#pragma once

#include "points.h"

namespace pcl_bsh::bench {

struct ScanPair {
  Points a;
  Points b;
  double spacing = 0.0; ///< what distances are multiples of
};

inline ScanPair shuffled(const ScanPair& pair)
{
  return {shuffled(pair.a, 5), shuffled(pair.b, 6), pair.spacing};
}

} // namespace pcl_bsh::bench
