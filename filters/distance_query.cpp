// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/distance_query.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/filters/parted_records.h>
#include <pcl_bsh/filters/surface_distances.h>
#include <pcl_bsh/geometry/exact_distance.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace pcl_bsh {
namespace {

/// A record without a distance is farther than all that was asked for. A distance that equals the length was rounded:
/// the coordinates decide. Within a ball of a surface, distances are 0.
class Comparison {
public:
  Comparison(const PointsView& input, const PointsView& obstacle, const Eigen::Isometry3d& pose,
             const PointDistances& found)
  : input_(input),
    obstacle_(obstacle),
    found_(found),
    exact_(Eigen::Isometry3d::Identity(), pose)
  {
  }

  /// Sign of the record's distance less the length.
  int compare(std::uint32_t record, double length) const
  {
    const double distance = found_.distance[record];
    if (std::isnan(distance)) return 1;
    if (distance != length) return distance < length ? -1 : 1;
    const std::uint32_t nearest = found_.nearest[record];
    const int sign = exact_.compare(input_.point(record), obstacle_.point(nearest), length, input_.radius(record),
                                    obstacle_.radius(nearest));
    return length == 0.0 ? std::max(sign, 0) : sign;
  }

private:
  const DefaultFloatEnvironment environment_;
  const PointsView& input_;
  const PointsView& obstacle_;
  const PointDistances& found_;
  const ExactDistance exact_;
};

} // namespace

DistanceQuery& DistanceQuery::operator=(const DistanceQuery& other)
{
  return *this = DistanceQuery(other); // moving allocates nothing
}

void DistanceQuery::requireSettings() const
{
  const auto [least, most] = limits_;
  if (!(0.0 <= least && least <= most && std::isfinite(least))) {
    throw std::invalid_argument("filter limits: from " + std::to_string(least) + " to " + std::to_string(most) +
                                ": give a finite least >= 0, and a most that is not less");
  }
  if (accuracy_.stopsEarly()) {
    throw std::invalid_argument("accuracy: " + accuracy_.text() +
                                ": leaves points without a distance: give exact or tolerance=LENGTH");
  }
  if (!(max_distance_ >= 0.0)) {
    throw std::invalid_argument("max distance: " + std::to_string(max_distance_) + ": give a length >= 0, or infinity");
  }
}

PointDistances DistanceQuery::within(const PointsView& input, double max_distance)
{
  requireSettings();
  const SphereHierarchy& obstacle = obstacle_.hierarchy(threads_);
  const SphereHierarchy hierarchy = hierarchyOf(input);
  PointDistancesRequest request;
  request.max_distance = max_distance;
  request.accuracy = accuracy_;
  request.threads = threads_;
  request.progress = progress_;
  PointDistances found = pointDistances({hierarchy}, {obstacle, pose_}, request);
  warnOf(hierarchy, nullptr, obstacle, {pose_}, std::nullopt);
  if (obstacle_.surface()) tellOfSurface(obstacle_.surface()->tolerance, found);
  work_ = found.work;
  return found;
}

/// How far the query must look to tell which points are within the limits.
double DistanceQuery::reachOfLimits() const
{
  return std::isinf(limits_.second) ? limits_.first : limits_.second;
}

PointDistances DistanceQuery::distances(const PointsView& input)
{
  return within(input, max_distance_);
}

void DistanceQuery::part(const PointsView& input, const PointDistances& found, bool negative, pcl::Indices& kept,
                         pcl::Indices* removed) const
{
  const Comparison distance(input, obstacle_.view(), pose_, found);
  const auto isWithin = [&, limits = limits_](std::uint32_t record) {
    const auto [least, most] = limits;
    return distance.compare(record, least) >= 0 && (std::isinf(most) || distance.compare(record, most) <= 0);
  };
  const auto keeps = [&](std::uint32_t record) {
    return isFinite(input.point(record)) && isWithin(record) != negative;
  };
  partRecords(input, keeps, kept, removed);
}

void DistanceQuery::select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed)
{
  part(input, within(input, reachOfLimits()), negative, kept, removed);
}

void DistanceQuery::select(const PointsView& input, bool negative, pcl::Indices& kept, pcl::Indices* removed,
                           std::vector<float>& distances)
{
  const PointDistances found = within(input, std::max(max_distance_, reachOfLimits()));
  const Comparison distance(input, obstacle_.view(), pose_, found);
  std::vector<float> told(input.count, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < input.size(); ++i) {
    const std::uint32_t record = input.record(i);
    if (distance.compare(record, max_distance_) <= 0) told[record] = static_cast<float>(found.distance[record]);
  }
  part(input, found, negative, kept, removed);
  distances = std::move(told);
}

} // namespace pcl_bsh
