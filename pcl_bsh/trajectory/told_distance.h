// SPDX-License-Identifier: BSD-3-Clause
// The one number that is told of a record's distance along a path.
#pragma once

#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_bsh {

/// The result has the distance as a float, and an interval where a solid encloses the record. A point's interval is a
/// double with its two neighbours: this returns that double. It returns the float for other records, or the end of the
/// interval next to it.
inline double toldDistance(const TrajectoryResult& found, std::size_t record)
{
  const auto rounded = static_cast<double>(found.distance[record]);
  if (found.interval.empty() || std::isnan(found.interval[record].lower)) return rounded;
  const auto [lower, upper] = found.interval[record];
  const double next = std::nextafter(lower, upper);
  return std::nextafter(next, upper) == upper ? next : std::clamp(rounded, lower, upper);
}

} // namespace pcl_bsh
