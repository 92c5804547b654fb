// SPDX-License-Identifier: BSD-3-Clause
// Clouds that make trees deep, leaves crowded or float coordinates blind, at full size: work counters must stay near
// those of an ordinary cloud, and a small stack must do. PCL_BSH_LONG_TESTS=1 in the environment: a million points
// each.
#include <pcl_bsh/collide.h>

#include "support/question.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

/// Runs on a thread with a quarter of the stack that main() has by default.
void onSmallStack(const std::function<void()>& body)
{
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, std::size_t{2} << 20), 0);
  pthread_t thread;
  const auto run = [](void* argument) -> void* {
    (*static_cast<const std::function<void()>*>(argument))();
    return nullptr;
  };
  ASSERT_EQ(pthread_create(&thread, &attributes, run, const_cast<std::function<void()>*>(&body)), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

std::size_t sizeOf(std::size_t usual)
{
  const char* asked = std::getenv("PCL_BSH_LONG_TESTS");
  return asked && *asked == '1' ? 1000000 : usual;
}

/// Work per point of the cloud; as many points as a query may cost before it is no longer about linear.
struct Limit {
  double node_pairs, leaf_pairs, exact_decisions;
};

void expectWithin(const Limit& limit, const Work& work, std::size_t points)
{
  const auto n = static_cast<double>(points);
  EXPECT_LT(static_cast<double>(work.node_pairs), 1000 + limit.node_pairs * n);
  EXPECT_LT(static_cast<double>(work.leaf_pairs), 1000 + limit.leaf_pairs * n);
  EXPECT_LT(static_cast<double>(work.exact_decisions), 1000 + limit.exact_decisions * n);
}

/// A cloud against itself, and against a copy of other points of the same kind; at clearance 0, where every point is a
/// tie, and at a small one.
void expectOrdinaryWork(std::size_t count, const std::function<Point3(std::size_t)>& point, const Limit& limit,
                        Scalar scalar = Scalar::float32)
{
  std::vector<Point3> points(count), others(count);
  for (std::size_t i = 0; i < count; ++i) {
    points[i] = point(i);
    for (std::size_t k = 0; k < 3; ++k) others[i][k] = 0.75 * points[i][k];
  }
  const Cloud a(points, {scalar}), b(others, {scalar});
  onSmallStack([&] {
    const SphereHierarchy ha(a.view()), hb(b.view());
    test::Question request;
    request.flagged = Flagged::both;
    const FlagsResult itself = collisionFlags({ha}, {ha}, request);
    EXPECT_EQ(itself.colliding_a, count);
    EXPECT_EQ(itself.colliding_b, count);
    expectWithin(limit, itself.work, count);
    const DistanceResult closest = closestPair({ha}, {ha});
    EXPECT_EQ(closest.distance, 0.0);
    EXPECT_EQ(closest.pair, (PointPair{0, 0}));
    expectWithin(limit, closest.work, count);
    expectWithin(limit, collisionFlags({ha}, {hb}, request).work, count);
    expectWithin(limit, anyCollision({ha}, {hb}, request).work, count);
    request.clearance = 1e-3;
    const FlagsResult near = collisionFlags({ha}, {ha}, request);
    EXPECT_EQ(near.colliding_a, count);
    expectWithin(limit, near.work, count);
  });
}

double power(std::size_t i)
{
  return std::exp2(-static_cast<double>(i % 149));
}

constexpr Limit ordinary = {20, 4, 8}; // twice what uniform points take

TEST(HardLimits, OrdinaryCloudForComparison)
{
  Random random(1);
  expectOrdinaryWork(
      100000, [&](std::size_t) { return random.point([&] { return random.uniform(-1, 1); }); }, ordinary);
}

TEST(HardLimits, H16MillionCoincidentPoints)
{
  expectOrdinaryWork(1000000, [](std::size_t) { return Point3{1.25, 2.5, 3.75}; }, {1e-3, 1e-3, 1e-3});
}

TEST(HardLimits, H17MillionCollinearPoints)
{
  expectOrdinaryWork(
      1000000,
      [](std::size_t i) {
        return Point3{static_cast<double>(i) * 1e-3, 0, 0};
      },
      ordinary);
}

TEST(HardLimits, H17PowersOfTwo)
{
  expectOrdinaryWork(
      1000000,
      [](std::size_t i) {
        return Point3{power(i), 0, 0};
      },
      ordinary);
}

TEST(HardLimits, H17PowersOfTwoInSpace) // every scale of float in one place, all points distinct
{
  const Limit limit = {100, 8, 150};
  expectOrdinaryWork(
      sizeOf(100000),
      [](std::size_t i) {
        return Point3{power(i), power(i / 149), power(i / 149 / 149)};
      },
      limit);
  expectOrdinaryWork(
      sizeOf(50000),
      [](std::size_t i) {
        return Point3{power(i % 37), power(i / 37 % 37), power(i / 37 / 37)};
      },
      limit);
}

TEST(HardLimits, H17MillionPointsOneUlpApart)
{
  const auto ulp = [](std::size_t k) { return 1 + static_cast<double>(k % 8) * 0x1p-23; };
  expectOrdinaryWork(
      1000000,
      [&](std::size_t i) {
        return Point3{ulp(i), ulp(i / 8), ulp(i / 64)};
      },
      ordinary);
}

TEST(HardLimits, H17Sphere)
{
  Random random(3);
  expectOrdinaryWork(
      sizeOf(100000),
      [&](std::size_t) {
        const Eigen::Vector3d p = random.rotation() * Eigen::Vector3d::UnitX();
        return Point3{p[0], p[1], p[2]};
      },
      ordinary);
}

TEST(HardLimits, H17OutlierBesideACluster)
{
  Random random(4);
  const std::size_t count = sizeOf(200000);
  expectOrdinaryWork(
      count,
      [&](std::size_t i) {
        return i == count / 2 ? Point3{1e6, 0, 0} : random.point([&] { return 1e-3 * random.uniform(-1, 1); });
      },
      ordinary);
}

TEST(HardLimits, ClustersBelowTheResolutionOfTheirVoxel) // 1e-12 wide, a metre apart
{
  Random random(5);
  expectOrdinaryWork(
      sizeOf(100000),
      [&](std::size_t i) {
        const double center = static_cast<double>(i % 2);
        return random.point([&] { return center + 1e-12 * random.uniform(-1, 1); });
      },
      {100, 8, 100}, Scalar::float64);
}

TEST(HardLimits, ScalesWithinScales) // a cloud at every power of two
{
  Random random(6);
  expectOrdinaryWork(sizeOf(30000),
                     [&](std::size_t i) {
                       const double scale = std::exp2(-static_cast<double>(i % 120));
                       return random.point([&] { return scale * random.uniform(-1, 1); });
                     },
                     {1000, 20, 1000});
}

} // namespace
} // namespace pcl_bsh
