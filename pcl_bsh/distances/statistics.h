// SPDX-License-Identifier: BSD-3-Clause
// A summary, for people, of the distances of many points: a few numbers, and a histogram.
#pragma once

#include <pcl_bsh/export.h>

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// All lengths in the clouds' unit, NaN where no point has a distance.
struct DistanceStatistics {
  static constexpr std::array<int, 5> percents = {5, 25, 75, 95, 99};

  std::size_t count = 0; ///< points that have a distance
  double mean = std::numeric_limits<double>::quiet_NaN();
  double rms = std::numeric_limits<double>::quiet_NaN(); ///< root of the mean square
  double median = std::numeric_limits<double>::quiet_NaN();
  std::array<double, percents.size()> percentiles = {median, median, median, median, median}; ///< those of `percents`
  double maximum = std::numeric_limits<double>::quiet_NaN();
};

/// Statistics of all entries except NaN. Percentile p of n values in order is at place (n - 1) p / 100, from 0. Between
/// two places it is interpolated linearly (Hyndman, Fan: Sample Quantiles in Statistical Packages, 1996, definition 7).
/// @param distance finite numbers and NaN
DistanceStatistics statisticsOf(const std::vector<double>& distance);

/// How many distances are in each of some intervals of the same width.
struct DistanceHistogram {
  double width = 1.0;              ///< > 0, in the clouds' unit
  std::vector<std::size_t> counts; ///< of [i width, (i + 1) width); the last one has its upper end, too
  std::size_t above = 0;           ///< beyond the last interval

  /// Where the last interval ends.
  double end() const { return width * static_cast<double>(counts.size()); }
};

/// Counts all entries except NaN; negative ones are in the first interval. The intervals reach from 0 to `end` or a
/// little farther: their width is 1, 2 or 5 times a power of ten.
/// @param end of the axis; a value that is not above 0 stands for no extent: one interval has all distances of 0
/// @param most_intervals > 0
DistanceHistogram histogramOf(const std::vector<double>& distance, double end, std::size_t most_intervals);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
