// SPDX-License-Identifier: BSD-3-Clause
#include "kernels.h"

#include <algorithm>
#include <iterator>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "test/distances/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/distances/distance_visit-inl.h>
#include <pcl_bsh/distances/rounded_lengths-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

void longLengthOnTarget(const std::array<double, 3>& p, const std::array<double, 3>& q,
                        const std::array<WithError, 3>& shift, test::LongLength& out)
{
  GivenPairs pairs;
  for (std::size_t k = 0; k < 3; ++k) {
    std::fill(std::begin(pairs.p[k]), std::end(pairs.p[k]), p[k]);
    std::fill(std::begin(pairs.q[k]), std::end(pairs.q[k]), q[k]);
  }
  out = {};
#if HWY_NATIVE_FMA
  const LongLengths found = longLengths(pairs, 0, shift);
  out = {hn::GetLane(found.root), hn::GetLane(found.correction), hn::FindFirstTrue(DoubleTag(), found.known) == 0, 0.0};
#endif
  double lengths[kLeafPoints];
  roundedLengths(pairs, 1, shift, lengths);
  out.rounded = lengths[0];
}

DistanceObstacle obstacleOf(const test::FrameBounds& frame)
{
  DistanceObstacle obstacle(nullptr, LocalFrame(), RelativeFrame(), 1.0, 1.0);
  obstacle.slack = frame.prune_reach;
  obstacle.least = frame.least;
  obstacle.most = frame.most;
  return obstacle;
}

void boundOfBoxOnTarget(const float* low, const float* high, const float* center, float radius, float stretch,
                        const test::FrameBounds& frame, test::DistanceBounds& out)
{
  float x[kLanes], y[kLanes], z[kLanes], r[kLanes], lower[kLanes];
  std::fill(std::begin(x), std::end(x), center[0]);
  std::fill(std::begin(y), std::end(y), center[1]);
  std::fill(std::begin(z), std::end(z), center[2]);
  std::fill(std::begin(r), std::end(r), radius);
  const SphereLanes spheres{x, y, z, r, stretch};
  const DistanceObstacle obstacle = obstacleOf(frame);
  boundFromBox(spheres, obstacle, low, high, lower);
  out = {lower[0], farthestFromBox(spheres, obstacle, low, high, 1)};
}

void boundDistanceOnTarget(const float* center, float radius, const float* other, float other_radius,
                           const test::FrameBounds& frame, test::DistanceBounds& out)
{
  CarriedNode spheres;
  std::fill(std::begin(spheres.x), std::end(spheres.x), center[0]);
  std::fill(std::begin(spheres.y), std::end(spheres.y), center[1]);
  std::fill(std::begin(spheres.z), std::end(spheres.z), center[2]);
  std::fill(std::begin(spheres.r), std::end(spheres.r), radius);
  float lower[kLanes], cut[kLanes];
  std::fill(std::begin(cut), std::end(cut), std::numeric_limits<float>::infinity());
  boundDistances(spheres, obstacleOf(frame), {other[0], other[1], other[2]}, other_radius, lower, cut);
  out = {lower[0], cut[0]};
}

void longTriangleDistanceOnTarget(const Point3& p, const Eigen::Isometry3d& pose_a, const Triangle3& t,
                                  const Eigen::Isometry3d& pose_b, test::LongTriangleDistance& out)
{
  LongTriangle triangle;
  triangle.set(t, pose_b);
  const bool moved_only = pose_a.matrix() == Eigen::Matrix4d::Identity();
  const LongVector place = moved_only ? LongVector(p) : LongVector(placedLong(pose_a, p));
  const NearPart part = nearPartOf(triangle, place);
  out = {static_cast<int>(part.kind), part.low, part.high, longDistance(triangle, part, place)};
}

void longTriangleOrderOnTarget(const Point3& p, const Eigen::Isometry3d& pose_a, const test::PosedTriangle& x,
                               const test::PosedTriangle& y, std::optional<int>& order)
{
  LongTriangle of_x, of_y;
  of_x.set(x.corners, x.pose);
  of_y.set(y.corners, y.pose);
  const LongVector place(placedLong(pose_a, p));
  const NearPart part_x = nearPartOf(of_x, place), part_y = nearPartOf(of_y, place);
  order = areSameParts(of_x, part_x, x.pose, of_y, part_y, y.pose) ? 0 : longOrder(of_x, part_x, of_y, part_y, place);
}

void lengthToSlabsOnTarget(const test::Held& held, const std::array<float, 3>& place, float& length)
{
  const LaneTag d;
  const auto point = [](const std::array<float, 3>& p) { return Point{p[0], p[1], p[2]}; };
  const CrossedSlabs slabs{point(held.normal), point(held.cross),  held.h,
                           held.cross_h,       point(held.center), held.radius};
  length = hn::GetLane(lengthToSlabs(slabs, hn::Set(d, place[0]), hn::Set(d, place[1]), hn::Set(d, place[2])));
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {
HWY_EXPORT(longLengthOnTarget);
HWY_EXPORT(boundOfBoxOnTarget);
HWY_EXPORT(boundDistanceOnTarget);
HWY_EXPORT(longTriangleDistanceOnTarget);
HWY_EXPORT(longTriangleOrderOnTarget);
HWY_EXPORT(lengthToSlabsOnTarget);
} // namespace

namespace test {

LongLength longLength(const std::array<double, 3>& p, const std::array<double, 3>& q,
                      const std::array<WithError, 3>& shift)
{
  LongLength found;
  HWY_DYNAMIC_DISPATCH(longLengthOnTarget)(p, q, shift, found);
  return found;
}

DistanceBounds boundDistance(const float (&center)[3], float radius, const float (&other)[3], float other_radius,
                             const FrameBounds& frame)
{
  DistanceBounds found;
  HWY_DYNAMIC_DISPATCH(boundDistanceOnTarget)(center, radius, other, other_radius, frame, found);
  return found;
}

DistanceBounds boundOfBox(const float (&low)[3], const float (&high)[3], const float (&center)[3], float radius,
                          float stretch, const FrameBounds& frame)
{
  DistanceBounds found;
  HWY_DYNAMIC_DISPATCH(boundOfBoxOnTarget)(low, high, center, radius, stretch, frame, found);
  return found;
}

LongTriangleDistance longTriangleDistance(const Point3& p, const Eigen::Isometry3d& pose_a, const Triangle3& t,
                                          const Eigen::Isometry3d& pose_b)
{
  LongTriangleDistance found;
  HWY_DYNAMIC_DISPATCH(longTriangleDistanceOnTarget)(p, pose_a, t, pose_b, found);
  return found;
}

std::optional<int> longTriangleOrder(const Point3& p, const Eigen::Isometry3d& pose_a, const PosedTriangle& x,
                                     const PosedTriangle& y)
{
  std::optional<int> order;
  HWY_DYNAMIC_DISPATCH(longTriangleOrderOnTarget)(p, pose_a, x, y, order);
  return order;
}

float lengthToSlabs(const Held& held, const std::array<float, 3>& place)
{
  float length = 0.0f;
  HWY_DYNAMIC_DISPATCH(lengthToSlabsOnTarget)(held, place, length);
  return length;
}

} // namespace test
} // namespace pcl_bsh
#endif
