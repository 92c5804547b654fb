// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/query/accuracy.h>

#include "support/question.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;
using test::Shape;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Verdict kFree = Verdict::free;
constexpr Verdict kUndecided = Verdict::undecided;

/// A scene, its hierarchies, and what is true of it.
class Truth {
public:
  explicit Truth(std::uint64_t seed, int max_points = 300)
  : scene(test::anyScene(seed, max_points)),
    a(scene.a.view()),
    b(scene.b.view())
  {
    flags = brute_force::collisionFlags(placedA(), placedB(), at(Accuracy::exact()));
    any = brute_force::anyCollision(placedA(), placedB(), at(Accuracy::exact()));
    distance = brute_force::closestPair(placedA(), placedB());
  }

  Placed placedA() const { return {a, scene.pose_a}; }
  Placed placedB() const { return {b, scene.pose_b}; }

  test::Question at(const Accuracy& accuracy) const
  {
    test::Question request;
    request.clearance = scene.clearance;
    request.flagged = Flagged::both;
    request.accuracy = accuracy;
    return request;
  }

  AnyResult anyAt(const Accuracy& accuracy) const { return anyCollision(placedA(), placedB(), at(accuracy)); }
  FlagsResult flagsAt(const Accuracy& accuracy) const { return collisionFlags(placedA(), placedB(), at(accuracy)); }
  DistanceResult distanceAt(const Accuracy& accuracy) const { return closestPair(placedA(), placedB(), at(accuracy)); }

  Scene scene;
  SphereHierarchy a, b;
  FlagsResult flags;
  AnyResult any;
  DistanceResult distance;
};

void expectHolds(const Interval& interval, double truth)
{
  EXPECT_LE(interval.lower, truth);
  EXPECT_GE(interval.upper, truth);
}

void expectNoneWrong(const std::vector<Verdict>& flags, const std::vector<Verdict>& truth, std::size_t marked)
{
  ASSERT_EQ(flags.size(), truth.size());
  std::size_t undecided = 0;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] == kUndecided)
      ++undecided;
    else
      ASSERT_EQ(flags[i], truth[i]) << "point " << i;
  }
  EXPECT_EQ(undecided, marked);
}

/// Rules of any certified answer.
void expectCertified(const Truth& truth, const Accuracy& accuracy)
{
  SCOPED_TRACE(truth.scene.name + " at " + accuracy.text());
  const AnyResult any = truth.anyAt(accuracy);
  if (any.verdict != Verdict::undecided) {
    EXPECT_EQ(any.verdict, truth.any.verdict);
  }
  EXPECT_EQ(any.pair.has_value(), any.verdict == Verdict::colliding);
  expectHolds(any.interval, truth.distance.distance);
  const FlagsResult flags = truth.flagsAt(accuracy);
  expectNoneWrong(flags.a, truth.flags.a, flags.undecided_a);
  expectNoneWrong(flags.b, truth.flags.b, flags.undecided_b);
  const DistanceResult distance = truth.distanceAt(accuracy);
  expectHolds(distance.interval, truth.distance.distance);
  EXPECT_EQ(distance.pair.has_value(), truth.distance.pair.has_value());
  EXPECT_GE(distance.distance, truth.distance.distance);
  EXPECT_LE(distance.distance, distance.interval.upper);
}

std::vector<Accuracy> levels()
{
  std::vector<Accuracy> all;
  for (unsigned level = 0; level <= 8; ++level) all.push_back(Accuracy::level(level));
  all.push_back(Accuracy::level(100));
  return all;
}

std::vector<Accuracy> budgets()
{
  std::vector<Accuracy> all = {Accuracy::nodePairs(0)};
  for (std::uint64_t count = 1; count <= (1u << 17); count *= 4) all.push_back(Accuracy::nodePairs(count));
  return all;
}

TEST(Accuracy, ReadsWhatItWrites)
{
  for (const char* text : {"exact", "tolerance=0.01", "level=3", "pairs=65536", "pairs=1000000", "time=0.001",
                           "tolerance=0", "pairs=9223372036854774784", "pairs=9223372036854775808"}) {
    EXPECT_EQ(Accuracy::parse(text).text(), text);
  }
  EXPECT_EQ(Accuracy::parse("time=0.25").value, 0.25);
  EXPECT_EQ(Accuracy::parse("level=4").mode, Accuracy::Mode::level);
}

TEST(Accuracy, RefusesWhatIsNone)
{
  for (const char* text : {"", "exakt", "float", "exact=1", "tolerance", "tolerance=", "tolerance=-1", "tolerance=nan",
                           "level=1.5", "time=1s", "pairs=1e400", "level=2 ", "time=inf"}) {
    try {
      Accuracy::parse(text);
      ADD_FAILURE() << text;
    }
    catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("'" + std::string(text) + "'"), std::string::npos) << error.what();
    }
  }
  const Cloud one({{1, 2, 3}});
  const SphereHierarchy point(one.view());
  for (const double bad : {-1.0, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    test::Question request;
    request.accuracy = Accuracy::tolerance(bad);
    EXPECT_THROW(anyCollision({point}, {point}, request), std::invalid_argument);
    EXPECT_THROW(collisionFlags({point}, {point}, request), std::invalid_argument);
    EXPECT_THROW(closestPair({point}, {point}, request), std::invalid_argument);
  }
}

TEST(Accuracy, LevelsAreNeverWrong)
{
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const Truth truth(seed);
    for (const Accuracy& accuracy : levels()) expectCertified(truth, accuracy);
  }
}

TEST(Accuracy, BudgetsAreNeverWrong)
{
  for (std::uint64_t seed = 200; seed < 350; ++seed) {
    const Truth truth(seed);
    for (const Accuracy& accuracy : budgets()) expectCertified(truth, accuracy);
  }
}

TEST(Accuracy, TimesAreNeverWrong)
{
  for (std::uint64_t seed = 400; seed < 460; ++seed) {
    const Truth truth(seed);
    for (const double seconds : {0.0, 1e-6, 1e-5, 1e-4, 10.0}) expectCertified(truth, Accuracy::time(seconds));
  }
}

/// More level or budget: every interval within the one before, every decision kept.
void expectNarrowing(const Truth& truth, const std::vector<Accuracy>& settings)
{
  Interval distance;
  AnyResult any;
  any.verdict = Verdict::undecided;
  FlagsResult flags = truth.flagsAt(settings.front());
  for (const Accuracy& accuracy : settings) {
    SCOPED_TRACE(truth.scene.name + " at " + accuracy.text());
    const Interval next = truth.distanceAt(accuracy).interval;
    EXPECT_GE(next.lower, distance.lower);
    EXPECT_LE(next.upper, distance.upper);
    const AnyResult next_any = truth.anyAt(accuracy);
    if (any.verdict != Verdict::undecided) {
      EXPECT_EQ(next_any.verdict, any.verdict);
    }
    if (next_any.verdict == Verdict::undecided) { // a decided one stops, and knows no more than it needs
      EXPECT_GE(next_any.interval.lower, any.interval.lower);
      EXPECT_LE(next_any.interval.upper, any.interval.upper);
    }
    const FlagsResult next_flags = truth.flagsAt(accuracy);
    for (std::size_t i = 0; i < flags.a.size(); ++i) {
      if (flags.a[i] != kUndecided) {
        ASSERT_EQ(next_flags.a[i], flags.a[i]) << i;
      }
    }
    distance = next, any = next_any, flags = next_flags;
  }
  EXPECT_EQ(flags.undecided_a, 0u);
  EXPECT_EQ(flags.undecided_b, 0u);
  EXPECT_EQ(any.verdict, truth.any.verdict);
  if (truth.distance.pair) {
    EXPECT_LE(distance.upper - distance.lower, 1e-12 * (1 + std::abs(truth.distance.distance)));
  }
}

TEST(Accuracy, DeeperLevelsNarrow)
{
  for (std::uint64_t seed = 500; seed < 620; ++seed) expectNarrowing(Truth(seed), levels());
}

TEST(Accuracy, LargerBudgetsNarrow)
{
  std::vector<Accuracy> all = budgets();
  all.push_back(Accuracy::nodePairs(std::uint64_t{1} << 40));
  for (std::uint64_t seed = 700; seed < 820; ++seed) expectNarrowing(Truth(seed), all);
}

TEST(Accuracy, BudgetsAreTheSameForAnyNumberOfThreads)
{
  for (std::uint64_t seed = 900; seed < 930; ++seed) {
    const Truth truth(seed, 1000);
    for (const Accuracy& accuracy : {Accuracy::level(1), Accuracy::level(2), Accuracy::nodePairs(500)}) {
      test::Question request = truth.at(accuracy);
      const FlagsResult expected = collisionFlags(truth.placedA(), truth.placedB(), request);
      request.threads = 4;
      const FlagsResult result = collisionFlags(truth.placedA(), truth.placedB(), request);
      EXPECT_EQ(result.a, expected.a);
      EXPECT_EQ(result.b, expected.b);
    }
  }
}

TEST(Accuracy, ToleranceErrsOnlyWithinIt)
{
  std::size_t earlier = 0;
  for (std::uint64_t seed = 1000; seed < 1150; ++seed) {
    const Truth truth(seed);
    for (const double part : {0.0, 1e-9, 0.01, 0.3, 2.0}) {
      const double length = part * (truth.scene.clearance + 1e-3);
      const Accuracy accuracy = Accuracy::tolerance(length);
      SCOPED_TRACE(truth.scene.name + " at " + accuracy.text());
      test::Question wide = truth.at(Accuracy::exact());
      wide.clearance = truth.scene.clearance + length;
      const FlagsResult most = brute_force::collisionFlags(truth.placedA(), truth.placedB(), wide);
      const FlagsResult flags = truth.flagsAt(accuracy);
      for (std::size_t i = 0; i < flags.a.size(); ++i) {
        ASSERT_LE(truth.flags.a[i], flags.a[i]);
        ASSERT_LE(flags.a[i], most.a[i]);
        earlier += flags.a[i] != truth.flags.a[i];
      }
      const AnyResult any = truth.anyAt(accuracy);
      if (any.verdict == Verdict::colliding) {
        EXPECT_GT(most.colliding_a, 0u);
      }
      else {
        EXPECT_EQ(any.verdict, Verdict::free);
        EXPECT_EQ(truth.any.verdict, Verdict::free);
      }
      expectHolds(any.interval, truth.distance.distance);
      const DistanceResult distance = truth.distanceAt(accuracy);
      expectHolds(distance.interval, truth.distance.distance);
      if (truth.distance.pair) {
        EXPECT_LE(distance.distance, truth.distance.distance + length + 1e-15 * std::abs(truth.distance.distance));
      }
    }
  }
  EXPECT_GT(earlier, 0u) << "no tolerance ever made a difference: nothing was tested";
}

struct TwoSurfaces {
  TwoSurfaces()
  : a_points(test::makePoints(Shape::sphere, 20000, 1, random)),
    b_points(test::makePoints(Shape::sphere, 20000, 1, random)),
    pose(Eigen::Translation3d(2.2, 0, 0))
  {
  }

  Random random = Random(77);
  Cloud a_points, b_points;
  SphereHierarchy a{a_points.view()}, b{b_points.view()};
  Eigen::Isometry3d pose;
};

TEST(Accuracy, LevelZeroBuildsNothingForFlags)
{
  const TwoSurfaces scene;
  test::Question request;
  request.clearance = 0.25;
  request.flagged = Flagged::both;
  request.accuracy = Accuracy::level(0);
  const FlagsResult flags = collisionFlags({scene.a}, {scene.b, scene.pose}, request);
  EXPECT_EQ(flags.work.voxels_built, 0u);
  EXPECT_GT(flags.undecided_a, 0u);
  EXPECT_LT(flags.undecided_a, 10000u) << "most voxels are out of reach";
}

// Noise-free: a tolerance ends at nodes of its size, whose points are all near enough.
TEST(Accuracy, ToleranceOpensNothingSmaller)
{
  const TwoSurfaces scene;
  test::Question request;
  request.accuracy = Accuracy::tolerance(0.4);
  const DistanceResult found = closestPair({scene.a}, {scene.b, scene.pose}, request);
  EXPECT_EQ(found.work.leaf_pairs, 0u);
  request.accuracy = Accuracy::tolerance(20.0);
  EXPECT_EQ(closestPair({scene.a}, {scene.b, scene.pose}, request).work.node_pairs, 1u);
}

// Noise-free: what a setting saves, in tests of spheres and comparisons of leaves.
TEST(Accuracy, LessAccuracyIsLessWork)
{
  const TwoSurfaces scene;
  const auto cost = [&](const Accuracy& accuracy) {
    test::Question request;
    request.accuracy = accuracy;
    const Work work = closestPair({scene.a}, {scene.b, scene.pose}, request).work;
    return work.node_pairs + 16 * work.leaf_pairs;
  };
  const std::uint64_t exact = cost(Accuracy::exact());
  EXPECT_LE(cost(Accuracy::tolerance(0.01)), exact);
  EXPECT_LT(cost(Accuracy::tolerance(0.05)), exact);
  EXPECT_LE(cost(Accuracy::tolerance(0.2)), cost(Accuracy::tolerance(0.05)));
  for (unsigned level = 0; level < 4; ++level)
    EXPECT_LE(cost(Accuracy::level(level)), cost(Accuracy::level(level + 1)));
  EXPECT_LT(cost(Accuracy::level(0)) * 4, exact);
  EXPECT_LE(cost(Accuracy::nodePairs(64)), 64u + 16 * 2 + 256);
  EXPECT_EQ(cost(Accuracy::exact()), exact);
}

/// Voxels whose unit is not the cloud's: bounds are in the unit of the space that a walk has entered.
TEST(Accuracy, BoundsInVoxelsOfAnotherUnit)
{
  for (const double size : {1e-12, 1e-40, 1e20, 1e100}) {
    std::vector<Point3> points;
    for (int i = 0; i < 40; ++i) points.push_back({size * (i % 7), size * (i % 5), size * i});
    points.push_back({1.0, 3.0, 2.0});
    points.push_back({1e6, 0.0, 0.0});
    const Cloud cloud(points, {Scalar::float64, 0, 0}), one({{-1.0, 0.25, 0.0}}, {Scalar::float64, 0, 0});
    HierarchyOptions options;
    options.voxel_edge = 0.5;
    const SphereHierarchy a(cloud.view(), options), b(one.view());
    for (const bool turned : {false, true}) {
      const Placed first{turned ? b : a}, second{turned ? a : b};
      const double truth = brute_force::closestPair(first, second).distance;
      for (const Accuracy& accuracy :
           {Accuracy::level(0), Accuracy::level(2), Accuracy::level(9), Accuracy::nodePairs(1), Accuracy::nodePairs(30),
            Accuracy::nodePairs(100000), Accuracy::time(10.0)}) {
        test::Question request;
        request.accuracy = accuracy;
        const DistanceResult found = closestPair(first, second, request);
        EXPECT_LE(found.interval.lower, truth) << accuracy.text() << ", size " << size;
        EXPECT_GE(found.interval.upper, truth) << accuracy.text() << ", size " << size;
        request.clearance = truth;
        EXPECT_NE(anyCollision(first, second, request).verdict, Verdict::free) << accuracy.text() << ", size " << size;
      }
    }
  }
}

TEST(Accuracy, EmptyCloudsCollideWithNothingAtAnySetting)
{
  const Cloud none({}), one({{1, 2, 3}});
  const SphereHierarchy empty(none.view()), point(one.view());
  for (const char* text : {"exact", "tolerance=1", "level=0", "pairs=0", "time=0"}) {
    test::Question request;
    request.accuracy = Accuracy::parse(text);
    EXPECT_EQ(anyCollision({empty}, {point}, request).verdict, Verdict::free) << text;
    EXPECT_EQ(collisionFlags({point}, {empty}, request).a, std::vector<Verdict>{kFree}) << text;
    const DistanceResult distance = closestPair({point}, {empty}, request);
    EXPECT_EQ(distance.distance, infinity) << text;
    EXPECT_FALSE(distance.pair) << text;
    EXPECT_EQ(distance.interval.upper, infinity) << text;
  }
}

} // namespace
} // namespace pcl_bsh
