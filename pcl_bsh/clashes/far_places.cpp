// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/far_places.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/clashes/extent.h>
#include <pcl_bsh/clusters/clusters.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

void check(const PointsView& cloud, const PointDistances& found, double beyond, double cluster_distance)
{
  if (!(beyond >= 0.0)) {
    throw InvalidInput(Input::beyond, "beyond", plainText(beyond), "give a length >= 0").withValue(beyond);
  }
  if (!(std::isfinite(cluster_distance) && cluster_distance > 0.0)) {
    throw InvalidInput(Input::cluster_distance, "cluster distance", plainText(cluster_distance),
                       "give a finite length > 0")
        .withValue(cluster_distance);
  }
  if (found.distance.size() != cloud.count || found.closest_point.size() != cloud.count) {
    throw InvalidInput(Input::result, "result",
                       "has " + counted(found.distance.size(), "value") + " for " + counted(cloud.count, "point"),
                       "ask for the distances of this cloud");
  }
}

double distanceOf(const PointDistances& found, std::uint32_t record)
{
  return std::isnan(found.distance[record]) ? std::numeric_limits<double>::infinity() : found.distance[record];
}

void add(FarPlace& place, std::uint32_t record, const Extent& extent, const PointDistances& found)
{
  if (place.records.empty()) place.low = extent.low, place.high = extent.high;
  for (std::size_t k = 0; k < 3; ++k) {
    place.low[k] = std::min(place.low[k], extent.low[k]);
    place.high[k] = std::max(place.high[k], extent.high[k]);
  }
  const double distance = distanceOf(found, record);
  if (place.records.empty() || distance > place.distance) {
    place.distance = distance;
    place.point = record;
    place.closest_point = found.closest_point[record];
  }
  place.records.push_back(record);
}

} // namespace

std::vector<FarPlace> findFarPlaces(const PointsView& cloud, const PointDistances& found, double beyond,
                                    double cluster_distance)
{
  check(cloud, found, beyond, cluster_distance);
  std::vector<std::int32_t> far;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t record = cloud.record(i);
    if (!isFinite(cloud.point(record))) continue;
    if (std::isnan(found.distance[record]) || found.distance[record] > beyond)
      far.push_back(static_cast<std::int32_t>(record));
  }
  if (far.empty()) return {};
  std::sort(far.begin(), far.end());
  PointsView subset = cloud;
  subset.restrictTo(far.data(), far.size());
  const Clusters clusters = euclideanClusters(SphereHierarchy(subset), cluster_distance);

  std::vector<FarPlace> places(clusters.sizes.size());
  for (const std::int32_t i : far) {
    const auto record = static_cast<std::uint32_t>(i);
    add(places[static_cast<std::size_t>(clusters.of[record])], record, extentOf(cloud, record), found);
  }
  std::sort(places.begin(), places.end(), [](const FarPlace& a, const FarPlace& b) {
    if (a.distance != b.distance) return a.distance > b.distance;
    if (a.records.size() != b.records.size()) return a.records.size() > b.records.size();
    return a.records.front() < b.records.front();
  });
  return places;
}

} // namespace pcl_bsh
