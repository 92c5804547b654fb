// SPDX-License-Identifier: BSD-3-Clause
#include "neighbors.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/squared_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::brute_force {
namespace {

/// The finite points that the view names, once each, by ascending record number.
std::vector<std::uint32_t> recordsOf(const PointsView& view)
{
  std::vector<std::uint32_t> records;
  for (std::size_t i = 0; i < view.size(); ++i)
    if (isFinite(view.point(view.record(i)))) records.push_back(view.record(i));
  std::sort(records.begin(), records.end());
  return records;
}

ExactDistance unposed()
{
  return {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
}

/// All points within the radius, nearest first.
std::vector<std::uint32_t> nearestFirst(const PointsView& view, const Point3& query, double radius)
{
  if (!isFinite(query)) return {};
  const ExactDistance distance = unposed();
  std::vector<std::uint32_t> records;
  for (const std::uint32_t record : recordsOf(view))
    if (distance.compare(view.point(record), query, radius) <= 0) records.push_back(record);
  std::stable_sort(records.begin(), records.end(), [&](std::uint32_t x, std::uint32_t y) {
    return distance.compareGaps({view.point(x), query}, {view.point(y), query}) < 0;
  });
  return records;
}

std::size_t writeNearestFirst(const PointsView& view, const Point3& query, const std::vector<std::uint32_t>& records,
                              std::size_t most, Neighbors& found)
{
  found.indices.assign(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(std::min(most, records.size())));
  found.squared_distances.clear();
  for (const std::int32_t index : found.indices)
    found.squared_distances.push_back(squaredDistanceAsFloat(view.point(static_cast<std::uint32_t>(index)), query));
  return found.indices.size();
}

} // namespace

std::size_t radiusSearch(const SphereHierarchy& cloud, const Point3& query, double radius, Neighbors& found,
                         const RadiusOptions& options)
{
  const DefaultFloatEnvironment environment;
  const std::size_t most = options.most == 0 ? cloud.size() : options.most;
  return writeNearestFirst(cloud.view(), query, nearestFirst(cloud.view(), query, radius), most, found);
}

std::size_t nearestKSearch(const SphereHierarchy& cloud, const Point3& query, std::size_t k, Neighbors& found)
{
  const DefaultFloatEnvironment environment;
  constexpr double kAnyDistance = std::numeric_limits<double>::infinity();
  return writeNearestFirst(cloud.view(), query, nearestFirst(cloud.view(), query, kAnyDistance), k, found);
}

bool anyInRadius(const SphereHierarchy& cloud, const Point3& query, double radius)
{
  const DefaultFloatEnvironment environment;
  return !nearestFirst(cloud.view(), query, radius).empty();
}

std::size_t boxSearch(const SphereHierarchy& cloud, const Point3& low, const Point3& high,
                      std::vector<std::int32_t>& indices)
{
  indices.clear();
  for (const std::uint32_t record : recordsOf(cloud.view())) {
    const Point3 p = cloud.view().point(record);
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) inside = inside && low[k] <= p[k] && p[k] <= high[k];
    if (inside) indices.push_back(static_cast<std::int32_t>(record));
  }
  return indices.size();
}

} // namespace pcl_bsh::brute_force
