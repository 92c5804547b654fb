// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/surface_distances.h>

#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

/// NaN stays.
template <typename Length>
void raise(Length& distance)
{
  if (distance < 0) distance = 0;
}

void widen(double tolerance, Interval& interval)
{
  raise(interval.lower);
  raise(interval.upper);
  interval.upper = std::nextafter(interval.upper + tolerance, std::numeric_limits<double>::infinity());
}

} // namespace

void tellOfSurface(double tolerance, DistanceResult& found)
{
  raise(found.distance);
  widen(tolerance, found.interval);
}

void tellOfSurface(double tolerance, PointDistances& found)
{
  for (double& distance : found.distance) raise(distance);
  for (Interval& interval : found.interval) widen(tolerance, interval);
  raise(found.greatest);
}

void tellOfSurface(double tolerance, SymmetricDistances& found)
{
  tellOfSurface(tolerance, found.a);
  tellOfSurface(tolerance, found.b);
  raise(found.hausdorff);
}

void tellOfSurface(TrajectoryResult& found)
{
  for (float& distance : found.distance) raise(distance);
  for (PoseSummary& pose : found.poses) raise(pose.distance);
}

} // namespace pcl_bsh
