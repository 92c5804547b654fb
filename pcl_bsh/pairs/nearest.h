// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/query/result.h>

#include <limits>
#include <optional>

namespace pcl_bsh {

/// The nearest pair found so far.
struct Nearest {
  std::optional<PointPair> pair;
  double low = std::numeric_limits<double>::infinity();     ///< at most the gap of the pair
  double high = std::numeric_limits<double>::infinity();    ///< at least the gap of the pair
  double to_beat = std::numeric_limits<double>::infinity(); ///< what is not nearer than this is passed over
};

} // namespace pcl_bsh
