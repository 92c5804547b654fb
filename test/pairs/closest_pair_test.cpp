// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>

#include "support/kd_tree.h"
#include "support/meshes.h"
#include "support/random_clouds.h"
#include "support/work_counts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;
using test::Shape;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

void expectSameAsBruteForce(const Scene& scene)
{
  SCOPED_TRACE(scene.name);
  const SphereHierarchy a(scene.a.view()), b(scene.b.view());
  const DistanceResult expected = brute_force::closestPair({a, scene.pose_a}, {b, scene.pose_b});
  const DistanceResult result = closestPair({a, scene.pose_a}, {b, scene.pose_b});
  ASSERT_EQ(result.distance, expected.distance);
  ASSERT_EQ(result.pair, expected.pair) << (result.pair
                                                ? std::to_string(result.pair->a) + ", " + std::to_string(result.pair->b)
                                                : "none");
}

TEST(ClosestPair, SameAsBruteForceOnSmallClouds)
{
  for (std::uint64_t seed = 0; seed < 400; ++seed) expectSameAsBruteForce(test::anyScene(seed, 100));
}

TEST(ClosestPair, SameAsBruteForceOnLargerClouds)
{
  for (std::uint64_t seed = 1000; seed < 1030; ++seed) expectSameAsBruteForce(test::anyScene(seed, 1000));
  for (std::uint64_t seed = 2000; seed < 2004; ++seed) expectSameAsBruteForce(test::anyScene(seed, 3000));
}

TEST(ClosestPair, SameAsBruteForceOfTriangles)
{
  for (std::uint64_t seed = 0; seed < 300; ++seed) expectSameAsBruteForce(test::anyMeshScene(seed, 60));
  for (std::uint64_t seed = 300; seed < 306; ++seed) expectSameAsBruteForce(test::anyMeshScene(seed, 400));
}

/// Up to the distance itself, just below, and elsewhere.
TEST(ClosestPair, UpToADistanceIsAsBruteForce)
{
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = seed % 2 == 0 ? test::anyScene(seed, 100) : test::anyMeshScene(seed, 40);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed_a(a, scene.pose_a), placed_b(b, scene.pose_b);
    const DistanceResult all = closestPair(placed_a, placed_b);
    const double distance = std::max(all.distance, 0.0);
    if (!std::isfinite(distance)) continue;
    for (const double most : {distance, std::nextafter(distance, infinity),
                              std::max(0.0, std::nextafter(distance, 0.0)), 0.5 * distance, 2.0 * distance})
      for (const Accuracy& accuracy :
           {Accuracy::exact(), Accuracy::tolerance(0.01 * distance), Accuracy::nodePairs(50)}) {
        DistanceRequest request{Effort(accuracy)};
        request.max_distance = most;
        const DistanceResult expected = brute_force::closestPair(placed_a, placed_b, request);
        const DistanceResult found = closestPair(placed_a, placed_b, request);
        EXPECT_LE(found.interval.lower, all.distance);
        EXPECT_GE(found.interval.upper, all.distance);
        EXPECT_TRUE(!found.pair || found.distance <= std::nextafter(most, infinity));
        if (!accuracy.isExact()) continue;
        ASSERT_EQ(found.pair, expected.pair);
        ASSERT_EQ(found.distance, expected.distance);
      }
  }
}

/// Beyond the distance that is asked about, a search costs about as much as that for any collision.
TEST(ClosestPair, BeyondTheGreatestDistanceTakesLittleWork)
{
  Random random(9);
  std::vector<Point3> ground, body;
  for (int i = 0; i < 20000; ++i) ground.push_back({random.uniform(-10, 10), random.uniform(-10, 10), 0.0});
  for (int i = 0; i < 2000; ++i) body.push_back({random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(1, 2)});
  const Cloud cloud_a(ground), cloud_b(body);
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  DistanceRequest request;
  request.max_distance = 0.1;
  const DistanceResult none = closestPair({a}, {b}, request);
  EXPECT_FALSE(none.pair);
  EXPECT_EQ(none.distance, infinity);
  EXPECT_EQ(none.interval.lower, 0.1);
  EXPECT_EQ(none.interval.upper, infinity);
  EXPECT_LE(none.work.node_pairs, 2 * anyCollision({a}, {b}, 0.1).work.node_pairs + 16);
  EXPECT_GT(closestPair({a}, {b}).work.node_pairs, 10 * none.work.node_pairs);
  request.threads = 3;
  EXPECT_FALSE(closestPair({a}, {b}, request).pair);
}

/// Many pairs are decided one by one, and none becomes the best: the limit is just below what all of them have.
TEST(ClosestPair, JustBelowTheDistanceOfManyTies)
{
  const auto expectNone = [](const SphereHierarchy& a, const SphereHierarchy& b, const Eigen::Isometry3d& pose) {
    const Placed placed_a(a, pose), placed_b(b, pose);
    const DistanceResult nearest = closestPair(placed_a, placed_b);
    for (const unsigned threads : {1u, 3u})
      for (const double share : {1e-15, 1e-12, 1e-6, 0.2}) {
        DistanceRequest request;
        request.max_distance = nearest.interval.lower * (1.0 - share);
        request.threads = threads;
        EXPECT_FALSE(closestPair(placed_a, placed_b, request).pair) << share;
      }
  };
  const Eigen::Isometry3d turned(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  std::vector<Point3> low, high;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j) low.push_back({0.1 * i, 0.1 * j, 0.0}), high.push_back({0.1 * i, 0.1 * j, 0.25});
  const Cloud floor(low), ceiling(high);
  const test::TestMesh box = test::boxMesh(1, 1, 1);
  test::TestMesh lid = test::boxMesh(0.9, 0.9, 1);
  lid.move(Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.05, 1.001)));
  const test::TestMesh plate = test::gridMesh(12, 12, [](double u, double v) -> Point3 { return {u, v, 0}; });
  const test::TestMesh cover = test::gridMesh(12, 12, [](double u, double v) -> Point3 { return {u, v, 0.25}; });
  for (const Eigen::Isometry3d& pose : {Eigen::Isometry3d::Identity(), turned}) {
    expectNone(SphereHierarchy(floor.view()), SphereHierarchy(ceiling.view()), pose);
    expectNone(SphereHierarchy(viewOf(box.trianglesView())), SphereHierarchy(viewOf(lid.trianglesView())), pose);
    expectNone(SphereHierarchy(viewOf(plate.trianglesView())), SphereHierarchy(viewOf(cover.trianglesView())), pose);
  }
}

TEST(ClosestPair, OfTouchingPointsIsKnownToBeZero)
{
  const Cloud cloud({{1, 2, 3}, {4, 5, 6}});
  const SphereHierarchy a(cloud.view());
  const DistanceResult found = closestPair({a}, {a});
  EXPECT_EQ(found.distance, 0.0);
  EXPECT_EQ(found.interval.lower, 0.0);
  EXPECT_EQ(found.interval.upper, 0.0);
}

TEST(ClosestPair, SmallestOfManyEquals)
{
  Random random(6);
  for (int i = 0; i < 40; ++i) { // whole numbers: most distances occur many times
    const auto points = [&](int low) {
      std::vector<Point3> list(static_cast<std::size_t>(random.integer(1, 300)));
      for (Point3& p : list) p = random.point([&] { return random.integer(0, 5); });
      for (Point3& p : list) p[0] += low;
      return Cloud(list);
    };
    Eigen::Isometry3d quarter_turn = identity;
    quarter_turn.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    const Eigen::Isometry3d pose = i % 2 == 0 ? identity : quarter_turn;
    expectSameAsBruteForce({points(0), points(i % 10), pose, pose, 0, "whole numbers " + std::to_string(i)});
  }
  const Cloud same(std::vector<Point3>(3000, Point3{1.25, 2.5, 3.75}));
  const SphereHierarchy a(same.view()), b(same.view());
  const DistanceResult result = closestPair({a}, {b});
  EXPECT_EQ(result.distance, 0.0);
  EXPECT_EQ(result.pair, (PointPair{0, 0}));
}

TEST(ClosestPair, EqualDistancesUnderATurn) // ties that only exact arithmetic sees, or sees through
{
  Random random(3);
  for (int i = 0; i < 30; ++i) {
    std::vector<Point3> left, right;
    for (int k = 0; k < 60; ++k) {
      left.push_back({1e-3 * k, 0, 0});
      right.push_back({1e-3 * random.integer(0, 59), 5, 0});
    }
    const Eigen::Isometry3d pose = random.pose(10);
    expectSameAsBruteForce({Cloud(left), Cloud(right), pose, pose, 0, "parallel rows " + std::to_string(i)});
  }
}

TEST(ClosestPair, NothingIsInfinitelyFar)
{
  const Cloud none({}), bad({{nan, 0, 0}, {0, infinity, 0}}), one({{1, 2, 3}});
  const SphereHierarchy empty(none.view()), all_bad(bad.view()), point(one.view());
  for (const SphereHierarchy* nothing : {&empty, &all_bad}) {
    for (const SphereHierarchy* other : {&point, nothing}) {
      for (const DistanceResult& result : {closestPair({*nothing}, {*other}), closestPair({*other}, {*nothing})}) {
        EXPECT_EQ(result.distance, infinity);
        EXPECT_FALSE(result.pair);
      }
    }
  }
}

TEST(ClosestPair, DeepestOverlapOfBalls)
{
  Cloud a({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}), b({{1, 0, 0}, {12, 0, 0}});
  a.setRadii({0.5f, 4.0f, 0.0f});
  b.setRadii({0.25f, 3.0f});
  const SphereHierarchy ha(a.view()), hb(b.view());
  const DistanceResult result = closestPair({ha}, {hb});
  EXPECT_EQ(result.distance, 2.0 - 4.0 - 3.0);
  EXPECT_EQ(result.pair, (PointPair{1, 1}));
}

TEST(ClosestPair, BallsMatterFromAfar) // the smallest gap is not between the nearest centers
{
  Random random(31);
  for (int i = 0; i < 20; ++i) {
    Cloud a(test::makePoints(Shape::uniform, 300, 1, random)), b(test::makePoints(Shape::uniform, 300, 1, random));
    std::vector<float> radii(300, 0.01f);
    for (int k = 0; k < 5; ++k)
      radii[static_cast<std::size_t>(random.integer(0, 299))] = 0.5f + 0.25f * static_cast<float>(k % 3);
    a.setRadii(radii);
    if (i % 2 == 0) b.setRadii(radii);
    const double shift = 0.5 * i;
    expectSameAsBruteForce({a, b, random.pose(0.1), Eigen::Isometry3d(Eigen::Translation3d(shift, 0, 0)), 0, "balls"});
  }
}

TEST(ClosestPair, BallsOfDifferentSizeInOnePlace)
{
  Random random(79);
  for (int i = 0; i < 50; ++i) {
    std::vector<float> radii(static_cast<std::size_t>(random.integer(1, 100)));
    for (float& radius : radii) radius = static_cast<float>(random.integer(0, 8)) / 8;
    Cloud a(std::vector<Point3>(radii.size(), Point3{1, 2, 3})), b(std::vector<Point3>(radii.size(), Point3{1, 2, 5}));
    a.setRadii(radii);
    if (i % 2 == 0) b.setRadii(radii);
    expectSameAsBruteForce({a, b, identity, identity, 0, "one place"});
  }
}

TEST(ClosestPair, ScalesOutsideTheRangeOfFloat)
{
  for (const double scale : {0x1p-1000, 0x1p-400, 0x1p-140, 0x1p-100, 0x1p100, 0x1p126, 0x1p300, 0x1p900}) {
    Random random(17);
    for (int i = 0; i < 10; ++i) {
      const Shape shape = random.pick(test::all_shapes);
      const Cloud a(test::makePoints(shape, 100, scale, random), {Scalar::float64});
      const Cloud b(test::makePoints(shape, 100, scale, random), {Scalar::float64});
      const Eigen::Isometry3d pose = i % 2 == 0 ? identity : random.pose(3 * scale);
      expectSameAsBruteForce({a, b, identity, pose, 0, "scale " + std::to_string(std::log2(scale))});
    }
  }
}

TEST(ClosestPair, FartherThanAnyDouble)
{
  const Cloud a({{1.7e308, 0, 0}}, {Scalar::float64}), b({{-1.7e308, 0, 0}}, {Scalar::float64});
  const SphereHierarchy ha(a.view()), hb(b.view());
  const DistanceResult result = closestPair({ha}, {hb});
  EXPECT_EQ(result.distance, infinity);
  EXPECT_EQ(result.pair, (PointPair{0, 0}));
}

TEST(ClosestPair, SameAsKdTreeOnHundredThousandPoints)
{
  Random random(100001);
  for (const Shape shape : {Shape::uniform, Shape::sphere, Shape::clusters}) {
    const std::size_t count = 100000;
    const Cloud a(test::makePoints(shape, count, 1, random)), b(test::makePoints(Shape::sphere, count, 1, random));
    const Eigen::Isometry3d pose_a = random.pose(0.1), pose_b = Eigen::Translation3d(2.2, 0, 0) * random.pose(0.01);
    const SphereHierarchy ha(a.view()), hb(b.view());
    const DistanceResult result = closestPair({ha, pose_a}, {hb, pose_b});
    EXPECT_NEAR(result.distance, test::distanceByKdTree(a.view(), pose_a, b.view(), pose_b), 1e-12);
    ASSERT_TRUE(result.pair);
    EXPECT_EQ(result.distance,
              ExactDistance(pose_a, pose_b).gap({a.view().point(result.pair->a), b.view().point(result.pair->b)}));
  }
}

TEST(ClosestPair, PrunesMostOfTheWork) // bounds: twice what it takes today
{
  Random random(64);
  const Cloud a(test::makePoints(Shape::uniform, 20000, 1, random)),
      b(test::makePoints(Shape::sphere, 20000, 1, random));
  const SphereHierarchy ha(a.view()), hb(b.view());
  const Work beside = closestPair({ha}, {hb, Eigen::Isometry3d(Eigen::Translation3d(2.5, 0, 0))}).work;
  EXPECT_LT(beside.node_pairs, 15000u);
  EXPECT_LT(beside.leaf_pairs, 1100u);
  const Work inside = closestPair({ha}, {hb}).work;
  EXPECT_LT(inside.node_pairs, 130000u);
  EXPECT_LT(inside.leaf_pairs, 19000u);
}

/// A body of many voxels, far from another one: it is compared as a whole until the other one's spheres are as small.
TEST(ClosestPair, ComparesASmallCloudAsAWhole)
{
  Random random(65);
  const Cloud a(test::makePoints(Shape::sphere, 20000, 10, random)),
      b(test::makePoints(Shape::sphere, 2000, 0.5, random));
  HierarchyOptions options;
  options.voxel_edge = 0.125;
  const SphereHierarchy ha(a.view()), hb(b.view(), options);
  ASSERT_GT(hb.statistics().voxels, 100u);
  const Eigen::Isometry3d pose(Eigen::Translation3d(40, 10, 5));
  const Work work = closestPair({ha}, {hb, pose}, {Accuracy::tolerance(2.5)}).work;
  EXPECT_LT(work.node_pairs, 200u); // with each of its voxels from the start, ten times as many
}

/// Leaves that are large beside what comes near them are asked for their points, and few are compared.
TEST(ClosestPair, ComparesFewLeavesOfASparseCloud)
{
  Random random(66);
  const Cloud a(test::makePoints(Shape::sphere, 1000, 10, random)),
      b(test::makePoints(Shape::sphere, 5000, 0.5, random));
  const SphereHierarchy ha(a.view()), hb(b.view());
  const Eigen::Isometry3d pose = Eigen::Translation3d(11, 2, 1) * random.pose(0.1);
  const DistanceResult found = closestPair({ha}, {hb, pose});
  EXPECT_EQ(found.distance, brute_force::closestPair({ha}, {hb, pose}).distance);
  EXPECT_LT(found.work.leaf_pairs, 20u);
  EXPECT_LT(found.work.exact_decisions, 30u);
}

/// Near surfaces, of which best first alone would look at all before one pair of points.
TEST(ClosestPair, ToleranceDivesForANearPair)
{
  Random random(67);
  const Cloud a(test::makePoints(Shape::sphere, 50000, 1, random));
  const SphereHierarchy ha(a.view());
  const Work work =
      closestPair({ha}, {ha, Eigen::Isometry3d(Eigen::Translation3d(0.03, 0.02, 0.01))}, {Accuracy::tolerance(0.02)})
          .work;
  EXPECT_LT(work.node_pairs, 5000u);
}

TEST(ClosestPair, WorkIsTheSameOnEachFreshHierarchy)
{
  Random random(9);
  const Cloud a(test::makePoints(Shape::uniform, 20000, 1, random)),
      b(test::makePoints(Shape::sphere, 20000, 1, random));
  const Eigen::Isometry3d pose = Eigen::Translation3d(2.1, 0, 0) * random.pose(0.1);
  Work expected;
  for (const int time : {1, 2, 3}) {
    const SphereHierarchy ha(a.view()), hb(b.view());
    const Work work = closestPair({ha}, {hb, pose}).work;
    if (time == 1) expected = work;
    EXPECT_EQ(test::countsOf(work), test::countsOf(expected)) << time;
  }
}

TEST(ClosestPair, ManyThreadsOnOneFreshHierarchy)
{
  Random random(45);
  const Cloud a(test::makePoints(Shape::uniform, 50000, 1, random)),
      b(test::makePoints(Shape::sphere, 20000, 1, random));
  const Eigen::Isometry3d pose(Eigen::Translation3d(2.2, 0, 0));
  const SphereHierarchy ha(a.view()), hb(b.view()), reference_a(a.view()), reference_b(b.view());
  const DistanceResult expected = closestPair({reference_a}, {reference_b, pose});
  std::vector<DistanceResult> results(4);
  std::vector<std::thread> threads;
  for (DistanceResult& result : results) {
    threads.emplace_back([&] { result = closestPair({ha}, {hb, pose}); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const DistanceResult& result : results) {
    EXPECT_EQ(result.distance, expected.distance);
    EXPECT_EQ(result.pair, expected.pair);
  }
}

TEST(ClosestPair, RefusesWhatItCannotAnswer)
{
  const Cloud one({{1, 2, 3}});
  const SphereHierarchy point(one.view());
  EXPECT_THROW(closestPair({point}, {point}, {Accuracy::tolerance(-1)}), std::invalid_argument);
  Eigen::Isometry3d broken = identity;
  broken.matrix()(0, 3) = nan;
  EXPECT_THROW(closestPair({point, broken}, {point}), std::invalid_argument);
}

/// Many pairs at distances that differ by the last place of a double: a later one may be nearer than the upper bound,
/// and farther than the nearest.
TEST(ClosestPair, IntervalsHoldTheDistanceOfPairsThatRoundingSwaps)
{
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    std::vector<Point3> shell;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d p = random.rotation() * Eigen::Vector3d::UnitX();
      shell.push_back({p[0], p[1], p[2]});
    }
    const Cloud one({{0, 0, 0}}, {Scalar::float64, 0, 0}), other(shell, {Scalar::float64, 0, 0});
    const SphereHierarchy a(one.view()), b(other.view());
    const double truth = brute_force::closestPair(a, b).distance;
    for (const Accuracy& accuracy : {Accuracy::level(2), Accuracy::level(9), Accuracy::nodePairs(1'000'000)}) {
      DistanceRequest request;
      request.accuracy = accuracy;
      const DistanceResult found = closestPair(a, b, request);
      EXPECT_LE(found.interval.lower, truth) << seed << ", " << accuracy.text();
      EXPECT_GE(found.interval.upper, truth) << seed << ", " << accuracy.text();
    }
  }
}

} // namespace
} // namespace pcl_bsh
