// SPDX-License-Identifier: BSD-3-Clause
#include "points.h"

#include "nearest.h"
#include "random.h"

#include <algorithm>

namespace pcl_bsh::bench {
Points moved(const Points& points, const RigidPose& pose)
{
  Points result(points.size());
  std::transform(points.begin(), points.end(), result.begin(), [&](const Point& p) { return pose.apply(p); });
  return result;
}

Points shuffled(Points points, std::uint64_t seed)
{
  Random random(seed); // std::shuffle may differ between standard libraries
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
  return points;
}

double medianSpacing(const Points& points)
{
  constexpr std::size_t kSamples = 2000;
  const NearestDistance nearest(points);
  std::vector<double> distances;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSamples);
  for (std::size_t i = 0; i < points.size(); i += step) distances.push_back(nearest.toOther(points[i]));
  if (distances.empty()) return 0.0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

} // namespace pcl_bsh::bench
