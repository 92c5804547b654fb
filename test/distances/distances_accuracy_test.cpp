// SPDX-License-Identifier: BSD-3-Clause
// The dial: what less than exact distances promise, held against brute force.
#include "expect_distances.h"
#include "support/random_clouds.h"

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Scene;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class DistancesAccuracy : public testing::Test {
protected:
  /// Asks about random scenes, each with a limit and without.
  template <class Check>
  void forEachScene(const Check& check)
  {
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
      const Scene scene = test::anyScene(seed, 200);
      SCOPED_TRACE(scene.name);
      HierarchyOptions options;
      if (seed % 2 == 0) options.voxel_edge = std::max(1e-3, 4 * scene.clearance);
      const SphereHierarchy ha(scene.a.view(), options), hb(scene.b.view(), options);
      const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
      const PointDistances all = brute_force::pointDistances(a, b);
      for (const double max : {kInfinity, scene.clearance}) {
        PointDistancesRequest request;
        request.max_distance = max;
        check(a, b, request, brute_force::pointDistances(a, b, request), all);
        if (testing::Test::HasFailure()) return;
      }
    }
  }

  /// Every interval holds the distance; who has a distance, has the right one.
  static void expectCertain(const PointDistances& found, const PointDistances& truth, const PointDistances& all,
                            double max)
  {
    std::size_t undecided = 0;
    for (std::size_t i = 0; i < all.distance.size(); ++i) {
      const Interval& interval = found.interval[i];
      if (all.closest_point[i] == kNothing) { // no point, or nothing there
        EXPECT_TRUE(std::isnan(interval.lower) || interval.upper == kInfinity);
        continue;
      }
      EXPECT_LE(interval.lower, all.distance[i]) << i;
      EXPECT_GE(interval.upper, all.distance[i]) << i;
      if (found.closest_point[i] != kNothing) {
        EXPECT_EQ(found.closest_point[i], truth.closest_point[i]);
        EXPECT_EQ(found.distance[i], truth.distance[i]);
      }
      else if (interval.lower >= max) {
        EXPECT_EQ(truth.closest_point[i], kNothing) << i;
      }
      else {
        ++undecided;
      }
    }
    EXPECT_EQ(found.undecided, undecided);
  }
};

TEST_F(DistancesAccuracy, ToleranceKeepsWhoIsMeasuredAndTheDistanceWithinIt)
{
  forEachScene([](const Placed& a, const Placed& b, PointDistancesRequest request, const PointDistances& truth,
                  const PointDistances& all) {
    for (const double tolerance : {0.0, 0.01, 1.0}) {
      request.accuracy = Accuracy::tolerance(tolerance);
      const PointDistances found = pointDistances(a, b, request);
      EXPECT_EQ(found.undecided, 0u);
      for (std::size_t i = 0; i < truth.distance.size(); ++i) {
        ASSERT_EQ(std::isnan(found.distance[i]), std::isnan(truth.distance[i])) << i;
        if (std::isnan(truth.distance[i])) {
          EXPECT_TRUE(std::isnan(all.distance[i]) || found.interval[i].lower <= all.distance[i]);
          continue;
        }
        EXPECT_GE(found.distance[i], truth.distance[i]);
        EXPECT_LE(found.distance[i], std::nextafter(truth.distance[i] + tolerance, kInfinity));
        EXPECT_LE(found.interval[i].lower, truth.distance[i]);
        EXPECT_GE(found.interval[i].upper, truth.distance[i]);
      }
    }
  });
}

TEST_F(DistancesAccuracy, LevelsGiveCertainIntervalsThatShrink)
{
  forEachScene([](const Placed& a, const Placed& b, PointDistancesRequest request, const PointDistances& truth,
                  const PointDistances& all) {
    std::size_t undecided = ~std::size_t{0};
    for (const unsigned level : {0u, 1u, 2u, 3u, 5u, 60u}) {
      request.accuracy = Accuracy::level(level);
      const PointDistances found = pointDistances(a, b, request);
      expectCertain(found, truth, all, request.max_distance);
      EXPECT_LE(found.undecided, undecided);
      undecided = found.undecided;
    }
    EXPECT_EQ(undecided, 0u);
  });
}

TEST_F(DistancesAccuracy, BudgetsGiveCertainIntervalsAndInTheEndAllDistances)
{
  forEachScene([](const Placed& a, const Placed& b, PointDistancesRequest request, const PointDistances& truth,
                  const PointDistances& all) {
    for (const std::uint64_t count : {0u, 10u, 300u, 3000u, 1u << 30}) {
      request.accuracy = Accuracy::nodePairs(count);
      expectCertain(pointDistances(a, b, request), truth, all, request.max_distance);
      const SymmetricDistances both = symmetricDistances(a, b, request);
      expectCertain(both.a, truth, all, request.max_distance);
      EXPECT_TRUE(count < 1u << 30 || both.a.undecided + both.b.undecided == 0);
    }
    for (const double seconds : {0.0, 1e-5, 100.0}) {
      request.accuracy = Accuracy::time(seconds);
      const PointDistances found = pointDistances(a, b, request);
      expectCertain(found, truth, all, request.max_distance);
      EXPECT_TRUE(seconds < 1.0 || found.undecided == 0);
    }
  });
}

/// In the unit of large coordinates a limit as small as that is 0, which bounds nothing.
TEST_F(DistancesAccuracy, ASmallestLimitBoundsNoPointThatWasLeft)
{
  std::vector<Point3> points;
  for (int i = 0; i < 64; ++i) points.push_back({0x1p90 * i, 0, 0});
  const Cloud one(points), other({{0, 0x1p80, 0}, {0x1p96, 0x1p80, 0}});
  const SphereHierarchy a(one.view()), b(other.view());
  PointDistancesRequest request;
  request.max_distance = std::numeric_limits<double>::denorm_min();
  for (const Accuracy& accuracy : {Accuracy::nodePairs(1), Accuracy::nodePairs(20), Accuracy::level(1)}) {
    request.accuracy = accuracy;
    const PointDistances found = pointDistances({a}, {b}, request), truth = pointDistances({a}, {b});
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_GE(found.interval[i].upper, truth.distance[i]) << i;
  }
}

/// Passes that go farther down keep what the ones before told: of a budget that ends in the last one, each interval
/// lies in the one of the level that all passes before came to.
TEST_F(DistancesAccuracy, BudgetsKeepWhatEarlierPassesKnow)
{
  std::size_t undecided = 0, narrowed = 0;
  test::Random random(10);
  for (int round = 0; round < 10; ++round) {
    const Cloud one(test::makePoints(test::Shape::sphere, 800, 1, random)),
        other(test::makePoints(test::Shape::uniform, 800, 1, random));
    const SphereHierarchy a(one.view()), b(other.view());
    const auto at = [&](const Accuracy& accuracy) {
      PointDistancesRequest request;
      request.accuracy = accuracy;
      return pointDistances(a, b, request);
    };
    const PointDistances first = at(Accuracy::level(0)), second = at(Accuracy::level(2));
    const PointDistances found = at(Accuracy::nodePairs(first.work.node_pairs + second.work.node_pairs + 500));
    for (std::size_t i = 0; i < found.interval.size(); ++i) {
      EXPECT_GE(found.interval[i].lower, second.interval[i].lower) << i;
      EXPECT_LE(found.interval[i].upper, second.interval[i].upper) << i;
      undecided += found.closest_point[i] == kNothing;
      narrowed += found.closest_point[i] == kNothing && second.interval[i].lower > first.interval[i].lower;
    }
  }
  EXPECT_GT(undecided, 1000u);
  EXPECT_GT(narrowed, 500u) << "else nothing is tested";
}

/// The pass that finds how near the voxels are may spend the whole budget before the first node is opened. The points
/// then keep the bounds that the walk begins with. Budgets that do so are about what the coarse pass takes, and a
/// little more.
TEST_F(DistancesAccuracy, BudgetsSpentBeforeTheFirstStepLeaveIntervalsOfOverlappingBallsBelowZero)
{
  test::Random random(9);
  Cloud one(test::makePoints(test::Shape::sphere, 200, 0.1, random));
  one.setRadii(std::vector<float>(200, 1.0f));
  const SphereHierarchy whole(one.view());
  const PointDistances truth = brute_force::pointDistances(whole, whole);
  ASSERT_EQ(truth.greatest, -2.0);
  std::size_t begun = 0; // budgets that ended between a voxel of a and those of b
  for (std::uint64_t count = 0; count < 150; ++count) {
    SCOPED_TRACE(count);
    const SphereHierarchy a(one.view()), b(one.view());
    PointDistancesRequest request;
    request.accuracy = Accuracy::nodePairs(count);
    const PointDistances found = pointDistances(a, b, request);
    expectCertain(found, truth, truth, kInfinity);
    begun += found.work.voxels_built == 1;
  }
  EXPECT_GT(begun, 0u) << "else nothing is tested";
}

/// A gap above 0 that rounds to 0.
TEST_F(DistancesAccuracy, IntervalsHoldAGapBelowAllDoubles)
{
  Cloud ball({{0, 0, 0}}), beside({{1, 0x1p-600, 0}}, {Scalar::float64});
  ball.setRadii({1.0f});
  const SphereHierarchy a(beside.view()), b(ball.view());
  PointDistancesRequest request;
  request.accuracy = Accuracy::tolerance(0.0);
  const PointDistances found = pointDistances(a, b, request);
  EXPECT_EQ(found.distance[0], 0.0);
  EXPECT_LE(found.interval[0].lower, 0.0);
  EXPECT_GT(found.interval[0].upper, 0.0);
}

} // namespace
} // namespace pcl_bsh
