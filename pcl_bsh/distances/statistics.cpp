// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/distances/statistics.h>

#include <pcl_bsh/geometry/exact/compensated_sum.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

std::vector<double> measuredOf(const std::vector<double>& distance)
{
  std::vector<double> measured;
  measured.reserve(distance.size());
  for (const double d : distance) {
    if (!std::isnan(d)) measured.push_back(d);
  }
  return measured;
}

double percentileOf(const std::vector<double>& ascending, double percent)
{
  const double place = static_cast<double>(ascending.size() - 1) * percent / 100.0;
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 == ascending.size()) return ascending.back();
  return std::lerp(ascending[below], ascending[below + 1], place - static_cast<double>(below));
}

/// The least number that is not below `least` and is 1, 2 or 5 times a power of ten.
double roundWidth(double least)
{
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least) return factor * decade;
  }
  return 10.0 * decade;
}

} // namespace

DistanceStatistics statisticsOf(const std::vector<double>& distance)
{
  DistanceStatistics statistics;
  std::vector<double> values = measuredOf(distance);
  statistics.count = values.size();
  if (values.empty()) return statistics;
  std::sort(values.begin(), values.end());
  statistics.maximum = values.back();
  statistics.median = percentileOf(values, 50);
  for (std::size_t i = 0; i < statistics.percents.size(); ++i)
    statistics.percentiles[i] = percentileOf(values, statistics.percents[i]);

  // In shares of the largest, so that no square overflows.
  const double largest = std::max(std::abs(values.front()), std::abs(values.back()));
  const double unit = largest > 0.0 ? largest : 1.0;
  CompensatedSum sum, squares;
  for (const double value : values) {
    sum.add(value / unit);
    squares.addProduct(value / unit, value / unit);
  }
  const auto count = static_cast<double>(values.size());
  statistics.mean = unit * (sum.value() / count);
  statistics.rms = unit * std::sqrt(squares.value() / count);
  return statistics;
}

DistanceHistogram histogramOf(const std::vector<double>& distance, double end, std::size_t most_intervals)
{
  constexpr double shortest = 1e-300, longest = 1e300; // whose intervals are numbers, too
  DistanceHistogram histogram;
  const bool extended = end >= shortest;
  if (extended) {
    end = std::min(end, longest);
    histogram.width = roundWidth(end / static_cast<double>(most_intervals));
  }
  const double intervals = extended ? std::ceil(end / histogram.width) : 1.0;
  histogram.counts.resize(std::clamp<std::size_t>(static_cast<std::size_t>(intervals), 1, most_intervals));
  for (const double d : distance) {
    if (std::isnan(d)) continue;
    if (d > histogram.end()) {
      ++histogram.above;
      continue;
    }
    const auto interval = static_cast<std::size_t>(std::max(d, 0.0) / histogram.width);
    ++histogram.counts[std::min(interval, histogram.counts.size() - 1)];
  }
  return histogram;
}

} // namespace pcl_bsh
