// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/surface_answers.h>

#include <pcl_bsh/surface/triangle_answers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

TrajectoryResult ofTriangles(const SurfaceCover& cover, TrajectoryResult balls)
{
  TrajectoryResult found;
  if (!balls.flags.empty()) found.flags = triangleVerdicts(cover, balls.flags);
  found.colliding = countOf(found.flags, Verdict::colliding);
  found.undecided = countOf(found.flags, Verdict::undecided);
  if (!balls.distance.empty()) {
    const std::vector<std::uint32_t> nearest = nearestBalls(cover, balls.distance, balls.closest_pose);
    found.distance = ofBalls(nearest, balls.distance, std::numeric_limits<float>::quiet_NaN());
    for (float& distance : found.distance) raise(distance);
    if (!balls.closest_pose.empty()) found.closest_pose = ofBalls(nearest, balls.closest_pose, std::int32_t{kNothing});
    if (!balls.closest_point.empty())
      found.closest_point = ofBalls(nearest, balls.closest_point, std::uint32_t{kNothing});
  }
  if (!balls.first_pose.empty()) found.first_pose = triangleFirstPoses(cover, balls.first_pose);
  if (!balls.certain_pose.empty()) found.certain_pose = triangleFirstPoses(cover, balls.certain_pose);
  found.first_contact = balls.first_contact;
  found.certain_contact = balls.certain_contact;
  found.work = balls.work;
  return found;
}

PointDistances ofTriangles(const SurfaceCover& cover, PointDistances balls)
{
  PointDistances found;
  const std::vector<std::uint32_t> nearest = nearestBalls(cover, balls.distance);
  found.distance = ofBalls(nearest, balls.distance, std::numeric_limits<double>::quiet_NaN());
  found.nearest = ofBalls(nearest, balls.nearest, std::uint32_t{kNothing});
  found.measured = nearest.size() - static_cast<std::size_t>(std::count(nearest.begin(), nearest.end(), kNothing));
  found.undecided = balls.undecided;
  for (std::uint32_t t = 0; t < found.distance.size(); ++t) {
    if (!(found.distance[t] > found.greatest) && !(std::isnan(found.greatest) && found.distance[t] >= 0.0)) continue;
    found.greatest = found.distance[t];
    found.greatest_pair = PointPair{t, found.nearest[t]};
  }
  found.work = balls.work;
  return found;
}

} // namespace pcl_bsh
