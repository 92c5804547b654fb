// SPDX-License-Identifier: BSD-3-Clause
// Points that may be elsewhere than they were measured: colliding for certain, free for certain, or undecided.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/hierarchy/update.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/pairs/trace.h>

#include "support/brute_force/many_poses.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;
using Rational = boost::multiprecision::cpp_rational;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

FlagsRequest within(double clearance, Flagged flagged, unsigned threads = 1, const Accuracy& accuracy = {})
{
  return {clearance, flagged, {accuracy, threads}};
}

Scene uncertainScene(std::uint64_t seed, int most_points)
{
  Scene scene = test::anyScene(seed, most_points);
  Random random(seed + 1000000);
  const double scale = scene.clearance > 0.0 ? scene.clearance : 0.01;
  if (random.chance(0.8)) test::makeUncertain(scene.a, scale, random);
  if (random.chance(0.8)) test::makeUncertain(scene.b, scale, random);
  if (random.chance(0.3)) scene.clearance *= 2;
  return scene;
}

/// By rational numbers: -1 certain, 0 possible, 1 neither. Poses are translations.
int judge(const PointsView& a, const PointsView& b, const Eigen::Vector3d& shift_b, double clearance)
{
  int best = 1;
  for (std::uint32_t i = 0; i < a.count; ++i)
    for (std::uint32_t j = 0; j < b.count; ++j) {
      Rational squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Rational difference =
            Rational(a.point(i)[k]) - Rational(b.point(j)[k]) - Rational(shift_b[static_cast<Eigen::Index>(k)]);
        squared += difference * difference;
      }
      const Rational own = Rational(a.uncertainty) + Rational(a.ownUncertainty(i)) + Rational(b.uncertainty) +
                           Rational(b.ownUncertainty(j));
      const Rational reach = Rational(clearance) + Rational(a.radius(i)) + Rational(b.radius(j));
      const auto near = [&](const Rational& length) { return length >= 0 && squared <= length * length; };
      best = std::min(best, near(reach - own) ? -1 : near(reach + own) ? 0 : 1);
    }
  return best;
}

Verdict verdictOf(int judgement)
{
  return judgement < 0 ? Verdict::colliding : judgement == 0 ? Verdict::undecided : Verdict::free;
}

TEST(Uncertainty, BothEdgesToTheLastBit)
{
  // 0.3, 0.1 and 0.2 are none of them what they look like, nor do their sums round alike.
  std::size_t verdicts[3] = {};
  for (const double clearance : {0.3, 0.5, 1.0})
    for (const double of_a : {0.0, 0.1, 0x1p-3, 1e-30})
      for (const double of_b : {0.2, 0x1p-4, 1e-9})
        for (const float own : {0.0f, 0.1f, 0x1p-20f})
          for (const double sign : {-1.0, 1.0})
            for (int bits = -2; bits <= 2; ++bits) {
              double distance = clearance + sign * (of_a + of_b + own);
              for (int i = 0; i < std::abs(bits); ++i) distance = std::nextafter(distance, bits < 0 ? 0.0 : 10.0);
              Cloud cloud_a({{0, 0, 0}}, {Scalar::float64}), cloud_b({{distance, 0, 0}}, {Scalar::float64});
              cloud_a.setUncertainties(of_a, {own});
              cloud_b.setUncertainties(of_b, {});
              const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
              const Verdict expected =
                  verdictOf(judge(cloud_a.view(), cloud_b.view(), Eigen::Vector3d::Zero(), clearance));
              ASSERT_EQ(anyCollision({a}, {b}, {clearance, {}}).verdict, expected) << distance;
              ASSERT_EQ(collisionFlags({a}, {b}, within(clearance, Flagged::a)).a[0], expected) << distance;
              ++verdicts[test::numberOf(expected)];
            }
  for (const std::size_t count : verdicts) EXPECT_GT(count, 100u);
}

TEST(Uncertainty, SameAsBruteForceForAnyThreads)
{
  std::size_t verdicts[3] = {}, flags[3] = {};
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Scene scene = uncertainScene(seed, seed < 280 ? 100 : 700);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed_a(a, scene.pose_a), placed_b(b, scene.pose_b);
    const AnyResult brute = brute_force::anyCollision(placed_a, placed_b, {scene.clearance, {}});
    const FlagsResult all = brute_force::collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::both));
    for (const unsigned threads : {1u, 2u}) {
      const AnyResult any = anyCollision(placed_a, placed_b, {scene.clearance, threads});
      ASSERT_EQ(any.verdict, brute.verdict);
      ASSERT_EQ(any.pair.has_value(), any.verdict == Verdict::colliding);
      const FlagsResult found = collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::both, threads));
      ASSERT_EQ(found.a, all.a);
      ASSERT_EQ(found.b, all.b);
      ASSERT_EQ(found.colliding_a, all.colliding_a);
      ASSERT_EQ(found.undecided_a, all.undecided_a);
      ASSERT_EQ(found.undecided_b, all.undecided_b);
      const CollidingIndices lists =
          collidingIndices(placed_a, placed_b, within(scene.clearance, Flagged::both, threads));
      ASSERT_EQ(lists.a.size(), all.colliding_a);
      ASSERT_EQ(lists.undecided_b.size(), all.undecided_b);
      for (const std::int32_t i : lists.undecided_a) ASSERT_EQ(all.a[static_cast<std::size_t>(i)], Verdict::undecided);
    }
    ++verdicts[test::numberOf(brute.verdict)];
    for (const Verdict flag : all.a) ++flags[test::numberOf(flag)];
  }
  for (const std::size_t count : verdicts) EXPECT_GT(count, 30u);
  for (const std::size_t count : flags) EXPECT_GT(count, 500u);
}

TEST(Uncertainty, LessThanExactClaimsNothingFalse)
{
  std::size_t decided = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = uncertainScene(seed, 300);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed_a(a, scene.pose_a), placed_b(b, scene.pose_b);
    const FlagsResult all = brute_force::collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::a));
    const Verdict truth = brute_force::anyCollision(placed_a, placed_b, {scene.clearance, {}}).verdict;
    for (const Accuracy& accuracy : {Accuracy::level(0), Accuracy::level(2), Accuracy::nodePairs(40),
                                     Accuracy::nodePairs(4000), Accuracy::time(1.0)}) {
      SCOPED_TRACE(scene.name + " at " + accuracy.text());
      const AnyResult any = anyCollision(placed_a, placed_b, {scene.clearance, accuracy});
      if (any.verdict != Verdict::undecided) {
        ASSERT_EQ(any.verdict, truth);
      }
      ASSERT_EQ(any.pair.has_value(), any.verdict == Verdict::colliding);
      const FlagsResult found = collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::a, 1, accuracy));
      for (std::size_t i = 0; i < all.a.size(); ++i) {
        if (found.a[i] == Verdict::undecided) continue;
        ASSERT_EQ(found.a[i], all.a[i]) << i;
        ++decided;
      }
    }
    // Pairs within the tolerance beyond each edge may go either way.
    const double tolerance = 0.1 * scene.clearance;
    const FlagsResult wider =
        brute_force::collisionFlags(placed_a, placed_b, within(scene.clearance + tolerance, Flagged::a));
    const FlagsResult loose =
        collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::a, 1, Accuracy::tolerance(tolerance)));
    for (std::size_t i = 0; i < all.a.size(); ++i) {
      ASSERT_TRUE(loose.a[i] == all.a[i] || loose.a[i] == wider.a[i] ||
                  (all.a[i] == Verdict::free && loose.a[i] == Verdict::undecided))
          << scene.name << i;
    }
  }
  EXPECT_GT(decided, 1000u);
}

TEST(Uncertainty, IntervalsHoldTheDistanceWhateverTheTolerance)
{
  Cloud cloud_a({{0, 0, 0}}), cloud_b({{0.859375, 0, 0}, {0.9296875, 0, 0}});
  cloud_a.setUncertainties(0.125, {}); // certain up to 0.875
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  for (const double tolerance : {0.0, 1e-3, 0.0625, 0.25}) {
    const AnyResult found = anyCollision({a}, {b}, {1.0, Accuracy::tolerance(tolerance)});
    EXPECT_EQ(found.verdict, Verdict::colliding);
    EXPECT_GE(found.interval.upper, 0.859375) << tolerance;
    EXPECT_LE(found.interval.upper, 0.875 + tolerance + 1e-12) << tolerance;
  }
}

TEST(Uncertainty, OfManyPointsAtOnePlace)
{
  // One leaf holds them all, but they are not alike.
  std::vector<Point3> points(200, Point3{1, 1, 1});
  Cloud cloud_a(points), cloud_b({{1, 1, 2}});
  std::vector<float> own(200, 0.25f);
  own[77] = 1.0f;
  own[150] = 0.0f;
  cloud_a.setUncertainties(0.0, own);
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  EXPECT_TRUE(a.validate().none());
  for (const double clearance : {0.0, 0.5, 0.75, 0.8, 1.0, 1.25, 2.0}) {
    const FlagsResult found = collisionFlags({a}, {b}, within(clearance, Flagged::both));
    const FlagsResult expected = brute_force::collisionFlags({a}, {b}, within(clearance, Flagged::both));
    EXPECT_EQ(found.a, expected.a) << clearance;
    EXPECT_EQ(found.b, expected.b) << clearance;
  }
}

TEST(Uncertainty, WholeNodesAreTakenAtTheLeastReach)
{
  // Two heaps, each small against the clearance, and one point far away, which alone is well known.
  Random random(4);
  std::vector<Point3> points = test::makePoints(test::Shape::uniform, 500, 0.01, random);
  const Cloud cloud_b(points);
  for (Point3& p : points) p[0] += 0.7;
  points.push_back({100, 0, 0});
  Cloud cloud_a(points);
  std::vector<float> own(points.size(), 0.375f);
  own.back() = 0.0625f;
  cloud_a.setUncertainties(0.0, own);
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  for (const unsigned threads : {1u, 2u}) EXPECT_EQ(anyCollision({a}, {b}, {0.9, threads}).verdict, Verdict::undecided);
  const FlagsResult found = collisionFlags({a}, {b}, within(0.9, Flagged::both));
  EXPECT_EQ(found.undecided_a, 500u);
  EXPECT_EQ(found.undecided_b, 500u);
}

TEST(Uncertainty, NoneIsThePlainQuery)
{
  const Scene scene = test::anyScene(5, 500);
  Cloud zero = scene.a;
  zero.setUncertainties(0.0, std::vector<float>(scene.a.view().count, 0.0f));
  const SphereHierarchy a(scene.a.view()), b(scene.b.view()), of_zeros(zero.view());
  const FlagsResult plain =
      collisionFlags({a, scene.pose_a}, {b, scene.pose_b}, within(scene.clearance, Flagged::both));
  const FlagsResult found =
      collisionFlags({of_zeros, scene.pose_a}, {b, scene.pose_b}, within(scene.clearance, Flagged::both));
  EXPECT_EQ(found.a, plain.a);
  EXPECT_EQ(found.b, plain.b);
  EXPECT_EQ(found.undecided_a, 0u);
}

TEST(Uncertainty, CostsAtMostTwoQueries)
{
  Random random(3);
  const Cloud measured(test::makePoints(test::Shape::plane, 20000, 1.0, random));
  Cloud cloud_a = measured, cloud_b(test::makePoints(test::Shape::plane, 20000, 1.0, random));
  const SphereHierarchy plain(measured.view()), b(cloud_b.view());
  const double clearance = 0.02;
  const auto tests = [&](const SphereHierarchy& a) {
    a.buildAll();
    return collisionFlags({a}, {b}, within(clearance, Flagged::a)).work.node_pairs;
  };
  b.buildAll();
  cloud_a.setUncertainties(0.002, {});
  EXPECT_LE(tests(SphereHierarchy(cloud_a.view())), 1.4 * static_cast<double>(tests(plain)));
  std::vector<float> own(20000);
  for (float& length : own) length = static_cast<float>(random.uniform(0, 0.002));
  cloud_a.setUncertainties(0.0, own);
  cloud_b.setUncertainties(0.0, own);
  const SphereHierarchy a(cloud_a.view()), uncertain_b(cloud_b.view());
  uncertain_b.buildAll();
  a.buildAll();
  const FlagsResult found = collisionFlags({a}, {uncertain_b}, within(clearance, Flagged::a));
  EXPECT_GT(found.undecided_a, 100u);
  EXPECT_LE(found.work.node_pairs, 1.5 * static_cast<double>(tests(plain)));
  EXPECT_LT(found.work.exact_decisions, 20u); // floats decide the rest
}

TEST(Uncertainty, OfManyLeavesAtOnce)
{
  // A heap in the middle of a shell is near all of its leaves, and each length may be the one that decides.
  Random random(8);
  const auto inOneVoxel = [](std::vector<Point3> points) {
    for (Point3& p : points)
      for (double& x : p) x += 8.0;
    return points;
  };
  Cloud cloud_a(inOneVoxel(test::makePoints(test::Shape::uniform, 60, 0.02, random)));
  Cloud cloud_b(inOneVoxel(test::makePoints(test::Shape::sphere, 3000, 1.0, random)));
  const auto lengths = [&random](std::size_t count) {
    std::vector<float> own(count);
    for (float& length : own) length = static_cast<float>(random.uniform(0, 0.05));
    return own;
  };
  cloud_a.setUncertainties(0.001, lengths(60));
  cloud_b.setUncertainties(0.002, lengths(3000));
  std::size_t flags[3] = {};
  HierarchyOptions one_voxel;
  one_voxel.voxel_edge = 16.0;
  for (const bool listed : {true, false}) {
    const SphereHierarchy a(cloud_a.view(), one_voxel), b(cloud_b.view(), one_voxel);
    ASSERT_EQ(b.statistics().voxels, 1u);
    if (!listed) a.buildAll();
    for (const double clearance : {0.88, 0.9, 0.92, 0.94, 1.0, 1.02, 1.04, 1.06}) {
      const FlagsResult found = collisionFlags({a}, {b}, within(clearance, Flagged::both));
      const FlagsResult expected = brute_force::collisionFlags({a}, {b}, within(clearance, Flagged::both));
      ASSERT_EQ(found.a, expected.a) << clearance;
      ASSERT_EQ(found.b, expected.b) << clearance;
      ASSERT_EQ(found.undecided_a, expected.undecided_a) << clearance;
      for (const Verdict flag : found.a) ++flags[test::numberOf(flag)];
    }
  }
  for (const std::size_t count : flags) EXPECT_GT(count, 100u);
}

TEST(Uncertainty, FollowsARefitAndAnUpdate)
{
  Cloud cloud(std::vector<Point3>(40, Point3{0, 0, 0})), other({{1, 0, 0}});
  SphereHierarchy a(cloud.view());
  const SphereHierarchy b(other.view());
  const AnyRequest request{0.9, {}};
  EXPECT_EQ(anyCollision({a}, {b}, request).verdict, Verdict::free);
  cloud.setUncertainties(0.0, std::vector<float>(40, 0.2f));
  a.refit(cloud.view());
  EXPECT_EQ(anyCollision({a}, {b}, request).verdict, Verdict::undecided);
  cloud.setUncertainties(0.05, {});
  HierarchyUpdate update(a, nullptr, 0);
  update.commit(cloud.view());
  EXPECT_EQ(anyCollision({a}, {b}, request).verdict, Verdict::free);
  EXPECT_EQ(anyCollision({a}, {b}, {0.97, {}}).verdict, Verdict::undecided);
  EXPECT_EQ(anyCollision({a}, {b}, {1.04, {}}).verdict, Verdict::undecided);
  EXPECT_EQ(anyCollision({a}, {b}, {1.06, {}}).verdict, Verdict::colliding);
}

TEST(Uncertainty, AtManyPoses)
{
  std::size_t verdicts[3] = {};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Scene scene = uncertainScene(seed, 60);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed(a, scene.pose_a);
    Random random(seed);
    std::vector<Eigen::Isometry3d> poses(2, scene.pose_b);
    for (int i = 0; i < 30; ++i)
      poses.push_back(scene.pose_b * random.pose((scene.clearance + 0.01) * std::pow(10.0, random.integer(-4, 0))));
    for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::tolerance(0.0)}) {
      AnyRequest request{scene.clearance, {accuracy, static_cast<unsigned>(seed % 3) + 1}};
      double done = 0.0;
      request.progress = [&](double now) {
        EXPECT_GE(now, done);
        done = now;
        return true;
      };
      const AnyAtPoses found = anyCollisionAtPoses(placed, b, poses, request);
      const AnyAtPoses expected = brute_force::anyCollisionAtPoses(placed, b, poses, request);
      ASSERT_EQ(found.flags, expected.flags);
      EXPECT_EQ(found.colliding, expected.colliding);
      EXPECT_EQ(found.undecided, expected.undecided);
      EXPECT_TRUE(done == 1.0 || a.empty() || b.empty());
      for (const Verdict verdict : found.flags) ++verdicts[test::numberOf(verdict)];
    }
  }
  for (const std::size_t count : verdicts) EXPECT_GT(count, 100u);
}

TEST(Uncertainty, ATraceTellsBothSearches)
{
  std::size_t verdicts[3] = {};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = uncertainScene(seed, 400);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed_a(a, scene.pose_a), placed_b(b, scene.pose_b);
    anyCollision(placed_a, placed_b, {scene.clearance, {}}); // voxels are built: the same work from here on
    const AnyResult any = anyCollision(placed_a, placed_b, {scene.clearance, {}});
    const CollisionTrace trace = traceCollision(placed_a, placed_b, {scene.clearance, {}});
    ASSERT_EQ(trace.result.verdict, any.verdict);
    ASSERT_EQ(trace.result.pair, any.pair);
    ASSERT_EQ(test::countsOf(trace.result.work), test::countsOf(any.work));
    std::size_t compared = 0;
    for (const TracedSphere& sphere : trace.a) compared += sphere.fate == SphereFate::compared;
    EXPECT_LE(compared, any.work.leaf_pairs);
    if (any.verdict == Verdict::free) {
      EXPECT_TRUE(std::none_of(trace.a.begin(), trace.a.end(),
                               [](const TracedSphere& sphere) { return sphere.fate == SphereFate::kept; }));
    }
    ++verdicts[test::numberOf(any.verdict)];
  }
  for (const std::size_t count : verdicts) EXPECT_GT(count, 5u);
}

/// Free points near patches of the other surface, with and without uncertainties; ties at the patches' edges, too.
TEST(DensityGuard, SameAsBruteForce)
{
  std::size_t flags[4] = {};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Scene scene = seed % 2 == 0 ? uncertainScene(seed, 120) : test::anyScene(seed, 120);
    SCOPED_TRACE(scene.name);
    Random random(seed + 3000000);
    const double scale = scene.clearance > 0.0 ? scene.clearance : 0.01;
    std::map<Point3, float> at_place; // alike at the same place
    std::vector<float> spacings;
    for (std::uint32_t i = 0; i < scene.b.view().count; ++i) {
      const auto spacing =
          static_cast<float>(random.chance(0.5) ? scale * random.integer(0, 8) / 8
                                                : scale * random.uniform(0, random.chance(0.1) ? 3 : 1));
      const Point3 place = scene.b.view().point(i);
      spacings.push_back(isFinite(place) ? at_place.emplace(place, spacing).first->second : spacing);
    }
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed_a(a, scene.pose_a), placed_b(b, scene.pose_b);
    for (const unsigned threads : {1u, 2u}) {
      FlagsRequest request = within(scene.clearance, Flagged::both, threads);
      const FlagsResult without = collisionFlags(placed_a, placed_b, request);
      request.spacings_of_b = spacings.data();
      const FlagsResult truth = brute_force::collisionFlags(placed_a, placed_b, request);
      const FlagsResult found = collisionFlags(placed_a, placed_b, request);
      ASSERT_EQ(found.a, truth.a);
      ASSERT_EQ(found.b, truth.b);
      ASSERT_EQ(found.sparse_a, truth.sparse_a);
      ASSERT_EQ(found.undecided_a, truth.undecided_a);
      ASSERT_EQ(found.colliding_a, truth.colliding_a);
      for (std::size_t i = 0; i < found.a.size(); ++i) {
        ASSERT_EQ(found.a[i] == Verdict::sparse ? Verdict::free : found.a[i], without.a[i])
            << "only free points become sparse";
      }
      for (const Verdict flag : found.a) ++flags[test::numberOf(flag)];
      request.accuracy = Accuracy::nodePairs(60);
      const FlagsResult early = collisionFlags(placed_a, placed_b, request);
      for (std::size_t i = 0; i < early.a.size(); ++i) {
        if (early.a[i] != Verdict::undecided && early.a[i] != Verdict::sparse) {
          ASSERT_EQ(early.a[i], truth.a[i]) << i;
        }
      }
    }
  }
  for (const std::size_t count : flags) EXPECT_GT(count, 500u);
}

TEST(DensityGuard, TiesAreSparse)
{
  const Cloud cloud_a({{0, 0, 0}}), cloud_b({{1.75, 0, 0}, {9, 9, 9}});
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  FlagsRequest request = within(1.0, Flagged::a);
  for (const float spacing : {1.5f, std::nextafter(1.5f, 0.0f), std::nextafter(1.5f, 9.0f)}) {
    const std::vector<float> spacings = {spacing, 0.0f};
    request.spacings_of_b = spacings.data();
    EXPECT_EQ(collisionFlags({a}, {b}, request).a[0], (spacing < 1.5f ? Verdict::free : Verdict::sparse));
  }
}

TEST(DensityGuard, RefusesWhatIsNoSpacing)
{
  const Cloud cloud({{0, 0, 0}, {1, 1, 1}});
  const SphereHierarchy a(cloud.view());
  FlagsRequest request = within(1.0, Flagged::a);
  for (const double wrong : {-1.0, kInfinity, std::nan("")})
    for (const std::size_t place : {0u, 1u}) {
      std::vector<float> spacings = {0.0f, 0.0f};
      spacings[place] = static_cast<float>(wrong);
      request.spacings_of_b = spacings.data();
      EXPECT_THROW(collisionFlags({a}, {a}, request), InvalidInput);
    }
  const std::vector<float> spacings = {0.0f, 0.0f};
  request.spacings_of_b = spacings.data();
  EXPECT_THROW(collidingIndices({a}, {a}, request), InvalidInput);
}

TEST(Uncertainty, RefusesWhatIsNoLength)
{
  Cloud cloud({{0, 0, 0}, {1, 1, 1}});
  for (const double wrong : {-1.0, kInfinity, std::nan("")}) {
    cloud.setUncertainties(wrong, {});
    EXPECT_THROW(SphereHierarchy(cloud.view()), InvalidInput) << wrong;
    cloud.setUncertainties(0.0, {0.0f, static_cast<float>(wrong)});
    try {
      const SphereHierarchy hierarchy(cloud.view());
      FAIL() << wrong;
    }
    catch (const InvalidInput& error) {
      EXPECT_EQ(error.input(), Input::uncertainty);
      EXPECT_EQ(error.index(), 1u);
    }
  }
}

} // namespace
} // namespace pcl_bsh
