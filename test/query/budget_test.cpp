// SPDX-License-Identifier: BSD-3-Clause
// Budgets: spent once, however many questions share them, and spent on what decides.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/query/accuracy.h>

#include "support/adversarial_clouds.h"
#include "support/facing_sheets.h"
#include "support/question.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;
using test::Shape;

constexpr Verdict kUndecided = Verdict::undecided;

test::Question asking(const Accuracy& accuracy, double clearance, Flagged flagged = Flagged::both)
{
  test::Question request;
  request.accuracy = accuracy;
  request.clearance = clearance;
  request.flagged = flagged;
  return request;
}

/// With time to spare, it is the search of exact, step by step: what that decides in a time, this does.
TEST(Budget, TimedAnySearchesAsExactDoes)
{
  for (std::uint64_t seed = 4000; seed < 4100; ++seed) {
    const Scene scene = test::anyScene(seed, 500);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed_a{a, scene.pose_a}, placed_b{b, scene.pose_b};
    anyCollision(placed_a, placed_b, asking(Accuracy::exact(), scene.clearance)); // builds
    const AnyResult exact = anyCollision(placed_a, placed_b, asking(Accuracy::exact(), scene.clearance));
    const AnyResult timed = anyCollision(placed_a, placed_b, asking(Accuracy::time(3600), scene.clearance));
    EXPECT_EQ(timed.verdict, exact.verdict);
    EXPECT_EQ(timed.pair, exact.pair);
    EXPECT_EQ(timed.work.node_pairs, exact.work.node_pairs);
    EXPECT_EQ(timed.work.leaf_pairs, exact.work.leaf_pairs);
    const double truth = brute_force::closestPair(placed_a, placed_b).distance;
    for (const double seconds : {0.0, 1e-6, 1e-5, 1e-4}) {
      const AnyResult hurried = anyCollision(placed_a, placed_b, asking(Accuracy::time(seconds), scene.clearance));
      if (hurried.verdict != Verdict::undecided) {
        EXPECT_EQ(hurried.verdict, exact.verdict);
      }
      EXPECT_LE(hurried.interval.lower, truth);
      EXPECT_GE(hurried.interval.upper, truth);
    }
  }
}

/// Nothing is built yet, and time enough to build all of it.
TEST(Budget, TimeEnoughBuildsWhatAnySearchNeeds)
{
  for (std::uint64_t seed = 4200; seed < 4220; ++seed) {
    const Scene scene = test::anyScene(seed, 500);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view()), timed_a(scene.a.view()), timed_b(scene.b.view());
    const AnyResult exact =
        anyCollision({a, scene.pose_a}, {b, scene.pose_b}, asking(Accuracy::exact(), scene.clearance));
    const AnyResult timed =
        anyCollision({timed_a, scene.pose_a}, {timed_b, scene.pose_b}, asking(Accuracy::time(3600), scene.clearance));
    EXPECT_EQ(timed.verdict, exact.verdict);
    EXPECT_EQ(timed.pair, exact.pair);
  }
}

/// Built parts take time as well.
TEST(Budget, NoTimeEndsASearchAtOnce)
{
  const test::FacingSheets sheets(6, 5000);
  const SphereHierarchy a(sheets.a->view()), b(sheets.b->view());
  const Placed placed_a{a, sheets.pose_a}, placed_b{b, sheets.pose_b};
  const double clearance = 0.9 * closestPair(placed_a, placed_b).distance;
  const AnyResult exact = anyCollision(placed_a, placed_b, asking(Accuracy::exact(), clearance));
  const AnyResult hurried = anyCollision(placed_a, placed_b, asking(Accuracy::time(0), clearance));
  EXPECT_EQ(exact.verdict, Verdict::free);
  EXPECT_EQ(hurried.verdict, Verdict::undecided);
  EXPECT_LT(10 * hurried.work.node_pairs, exact.work.node_pairs);
}

struct TwoSurfaces {
  Random random = Random(77);
  Cloud a_points{test::makePoints(Shape::sphere, 20000, 1, random)};
  Cloud b_points{test::makePoints(Shape::sphere, 20000, 1, random)};
  Eigen::Isometry3d pose = Eigen::Isometry3d(Eigen::Translation3d(1.5, 0, 0));
};

/// Budgets of as many sphere tests as a tolerance takes give narrower intervals than it does, in the mean.
TEST(Budget, IntervalsAreNarrowerThanThoseOfATolerance)
{
  double logarithms = 0.0;
  Random random(4200);
  for (const Shape shape : {Shape::uniform, Shape::sphere, Shape::plane, Shape::clusters}) {
    const Cloud points_a(test::makePoints(shape, 20'000, 1.0, random)),
        points_b(test::makePoints(shape, 5'000, 0.3, random));
    const SphereHierarchy a(points_a.view()), b(points_b.view());
    for (int i = 0; i < 10; ++i) {
      const Point3 way = test::adversarial::direction(random);
      const Eigen::Isometry3d pose(Eigen::Translation3d(random.uniform(1.5, 8.0) * Eigen::Vector3d(way.data())));
      const double distance = closestPair({a}, {b, pose}).distance;
      for (const double part : {0.01, 0.1, 0.5}) {
        const DistanceResult tolerant = closestPair({a}, {b, pose}, {Accuracy::tolerance(part * distance)});
        const DistanceResult hurried = closestPair({a}, {b, pose}, {Accuracy::nodePairs(tolerant.work.node_pairs + 1)});
        EXPECT_LE(hurried.interval.lower, distance);
        EXPECT_GE(hurried.interval.upper, distance);
        const double width = hurried.interval.upper - hurried.interval.lower;
        logarithms += std::log(std::max(0.1, width / (tolerant.interval.upper - tolerant.interval.lower)));
      }
    }
  }
  EXPECT_LT(std::exp(logarithms / 120), 0.6);
}

TEST(Budget, BothSidesShareIt)
{
  const TwoSurfaces scene;
  const SphereHierarchy a(scene.a_points.view()), b(scene.b_points.view());
  const auto flagsAt = [&](const Accuracy& accuracy, Flagged flagged) {
    return collisionFlags({a}, {b, scene.pose}, asking(accuracy, 0.1, flagged));
  };
  const FlagsResult exact = flagsAt(Accuracy::exact(), Flagged::both);
  const std::uint64_t all = exact.work.node_pairs;
  for (const std::uint64_t budget : {all / 100, all / 10, all / 2}) {
    EXPECT_LE(flagsAt(Accuracy::nodePairs(budget), Flagged::both).work.node_pairs, budget + 4000) << budget;
    EXPECT_LE(flagsAt(Accuracy::nodePairs(budget), Flagged::a).work.node_pairs, budget + 4000) << budget;
  }
  // The budget that one side does not need is the other's.
  const FlagsResult enough = flagsAt(Accuracy::nodePairs(4 * all), Flagged::both);
  EXPECT_EQ(enough.a, exact.a);
  EXPECT_EQ(enough.b, exact.b);
  const FlagsResult timed = flagsAt(Accuracy::time(3600), Flagged::both);
  EXPECT_EQ(timed.a, exact.a);
  EXPECT_EQ(timed.b, exact.b);
  EXPECT_EQ(timed.colliding_b, exact.colliding_b);
}

/// It is the gap that counts, not how far middles are apart.
TEST(Budget, DecidesBallsByTheirGap)
{
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Point3> points(80);
    std::vector<float> radii(points.size());
    for (Point3& p : points) p = random.point([&] { return random.uniform(-1, 1); });
    for (float& radius : radii) radius = static_cast<float>(random.uniform(0.1, 0.4));
    const Cloud cloud(points, {Scalar::float64, 0, 0});
    PointsView view = cloud.view();
    view.radii = radii.data();
    const SphereHierarchy balls(view);
    const Placed a{balls}, b{balls, Eigen::Isometry3d(Eigen::Translation3d(4, 0, 0))};
    const double gap = closestPair(a, b).distance;
    for (const Accuracy& accuracy : {Accuracy::nodePairs(1000000), Accuracy::level(30)}) {
      EXPECT_EQ(anyCollision(a, b, asking(accuracy, gap + 0.01)).verdict, Verdict::colliding);
      EXPECT_EQ(anyCollision(a, b, asking(accuracy, gap - 0.01)).verdict, Verdict::free);
    }
  }
}

/// One point takes next to nothing of what both sides have.
TEST(Budget, WhatASmallCloudLeavesIsTheOthers)
{
  Random random(78);
  const Cloud few({{0.9, 0.1, 0.0}}), many(test::makePoints(Shape::sphere, 20000, 1, random));
  const SphereHierarchy a(few.view()), b(many.view());
  const auto flagsAt = [&](std::uint64_t budget, Flagged flagged) {
    return collisionFlags({a}, {b}, asking(Accuracy::nodePairs(budget), 0.5, flagged));
  };
  std::uint64_t need = 100;
  while (flagsAt(need, Flagged::b).undecided_b != 0) need += need / 8;
  const std::uint64_t needs_a = flagsAt(1u << 30, Flagged::a).work.node_pairs;
  ASSERT_LT(8 * needs_a, need);
  EXPECT_EQ(flagsAt(need + needs_a, Flagged::both).undecided_b, 0u);
  EXPECT_GT(flagsAt(need / 2, Flagged::b).undecided_b, 0u) << "else half would be enough";
}

/// A cloud that is built has nothing to take time for, whichever side it is.
TEST(Budget, TimeIsLeftToBuildOneSideAlone)
{
  Random random(79);
  const Cloud one(test::makePoints(Shape::uniform, 3000, 1, random)),
      other(test::makePoints(Shape::uniform, 3000, 1, random));
  const SphereHierarchy built(one.view());
  closestPair({built}, {SphereHierarchy(one.view()), Eigen::Isometry3d(Eigen::Translation3d(2.5, 0, 0))});
  const Eigen::Isometry3d pose(Eigen::Translation3d(2.5, 0, 0));
  const double truth = closestPair({built}, {SphereHierarchy(other.view()), pose}).distance;
  for (const bool is_a : {true, false}) {
    const SphereHierarchy fresh(other.view());
    const Placed at_pose(fresh, pose);
    const DistanceResult found = is_a ? closestPair({built}, at_pose, {Accuracy::time(3600)})
                                      : closestPair(at_pose, {built}, {Accuracy::time(3600)});
    EXPECT_EQ(found.distance, truth) << is_a;
    EXPECT_GT(found.interval.lower, 0.999 * truth) << is_a;
  }
}

TEST(Budget, LargerOnesKeepWhatSmallerOnesDecide)
{
  for (std::uint64_t seed = 4200; seed < 4230; ++seed) {
    const Scene scene = test::anyScene(seed, 600);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed_a{a, scene.pose_a}, placed_b{b, scene.pose_b};
    const FlagsResult truth = collisionFlags(placed_a, placed_b, asking(Accuracy::exact(), scene.clearance));
    FlagsResult before;
    before.a.assign(truth.a.size(), kUndecided);
    before.b.assign(truth.b.size(), kUndecided);
    for (std::uint64_t budget = 1; budget < (std::uint64_t{1} << 32);
         budget = budget < 20000 ? budget * 5 / 4 + 1 : budget * 2) {
      const FlagsResult found =
          collisionFlags(placed_a, placed_b, asking(Accuracy::nodePairs(budget), scene.clearance));
      const auto expectKept = [&](const std::vector<Verdict>& now, const std::vector<Verdict>& then,
                                  const std::vector<Verdict>& right) {
        for (std::size_t i = 0; i < now.size(); ++i) {
          ASSERT_TRUE(now[i] == right[i] || now[i] == kUndecided) << "point " << i << ", budget " << budget;
          ASSERT_TRUE(then[i] == kUndecided || now[i] == then[i]) << "point " << i << ", budget " << budget;
        }
      };
      expectKept(found.a, before.a, truth.a);
      expectKept(found.b, before.b, truth.b);
      before = found;
    }
    EXPECT_EQ(before.a, truth.a);
    EXPECT_EQ(before.b, truth.b);
  }
}

} // namespace
} // namespace pcl_bsh
