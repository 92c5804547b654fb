// SPDX-License-Identifier: BSD-3-Clause
// Distances of what solids hold: negative, the depth to the surface.
#include <pcl_bsh/question/solids.h>

#include <pcl_bsh/distances/point_distances.h>

#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

Interval outward(double lower, double upper)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {std::nextafter(lower, -infinity), std::nextafter(upper, infinity)};
}

/// Of what is held. @param width of a ball, 0 of a point or a triangle
Interval depthsOf(const Interval& distance, double width)
{
  if (width == 0.0) return {-distance.upper, -distance.lower};
  return outward(-(distance.upper + width), -(distance.lower + width));
}

} // namespace

PointDistances Solids::depths(const Pairing& pair, const Eigen::Isometry3d& pose, const Records& records) const
{
  PointDistancesRequest request;
  request.threads = question_.threads;
  const Placed b(b_.hierarchy(), pose);
  return pair.of_obstacle ? pointDistances(a_, records, b, request) : pointDistances(b, records, a_, request);
}

/// Of a ball: the distance is that of its near side, the depth that of its far side.
double Solids::widthOf(const Pairing& pair, std::uint32_t record) const
{
  return 2.0 * (pair.of_obstacle ? a_ : b_).hierarchy().view().ownRadius(record);
}

void Solids::turn(SymmetricDistances& found, bool both_ways)
{
  for (Pairing& pair : pairings_)
    if (pair.of_obstacle || both_ways) turn(pair, pair.of_obstacle ? found.a : found.b);
}

void Solids::turn(Pairing& pair, PointDistances& found)
{
  const Records& records = held(pair, found.work);
  Records deep; // beyond what was asked for
  for (const std::uint32_t record : records)
    if (std::isnan(found.distance[record])) deep.push_back(record);
  if (!deep.empty()) {
    const PointDistances measured = depths(pair, b_.pose, deep);
    for (const std::uint32_t record : deep) {
      found.distance[record] = measured.distance[record];
      found.closest_point[record] = measured.closest_point[record];
      if (!found.interval.empty())
        found.interval[record] = outward(measured.distance[record], measured.distance[record]);
      found.measured += !std::isnan(measured.distance[record]);
    }
  }
  for (const std::uint32_t record : records) {
    const double width = widthOf(pair, record);
    if (const double depth = found.distance[record] + width; depth > 0.0) found.distance[record] = -depth;
    if (!found.interval.empty()) found.interval[record] = depthsOf(found.interval[record], width);
  }
  found.greatest = std::numeric_limits<double>::quiet_NaN();
  found.greatest_pair.reset();
  for (std::uint32_t i = 0; i < found.distance.size(); ++i) {
    if (!(found.distance[i] > found.greatest) && !(std::isnan(found.greatest) && !std::isnan(found.distance[i])))
      continue;
    found.greatest = found.distance[i];
    found.greatest_pair = PointPair{i, found.closest_point[i]};
  }
}

void Solids::turn(DistanceResult& closest)
{
  for (Pairing& pair : pairings_) turn(pair, b_.pose, held(pair, closest.work), closest);
}

void Solids::turn(DistanceResult& closest, const Eigen::Isometry3d& pose) const
{
  for (const Pairing& pair : pairings_) turn(pair, pose, heldAt(pair, pose, closest.work), closest);
}

void Solids::turn(const Pairing& pair, const Eigen::Isometry3d& pose, const Records& held,
                  DistanceResult& closest) const
{
  if (held.empty()) return;
  const PointDistances measured = depths(pair, pose, held);
  for (const std::uint32_t record : held) {
    const double depth = measured.distance[record] + widthOf(pair, record);
    if (!(depth > 0.0) || closest.distance <= -depth) continue;
    closest.distance = -depth;
    const std::uint32_t nearest = measured.closest_point[record];
    closest.pair = pair.of_obstacle ? PointPair{record, nearest} : PointPair{nearest, record};
    closest.interval = outward(-depth, -depth);
  }
}

} // namespace pcl_bsh
