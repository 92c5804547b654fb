// SPDX-License-Identifier: BSD-3-Clause
// Costs of queries about two clouds where many pairs are at nearly one distance, as the clouds grow.
#include <pcl_bsh/collide.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/pairs/contacts.h>

#include "support/adversarial_clouds.h"
#include "support/made_meshes.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::HardPair;
using namespace test::adversarial;

double stepsOf(const Work& work)
{
  return static_cast<double>(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions);
}

/// Steps of a query on a pair of clouds.
template <class Query>
double stepsOf(const HardPair& hard, const Query& query)
{
  const test::Cloud a(hard.a), b(hard.b);
  const SphereHierarchy of_a(a.view()), of_b(b.view());
  return stepsOf(query(Placed(of_a), Placed(of_b, hard.pose_b), hard.clearance).work);
}

/// Holds a query's steps at n, 4 n and 16 n: at most 5 times as many for 4 times the points, one time with the other.
template <class Query>
void expectLinear(const char* name, const std::function<HardPair(std::size_t)>& make, std::size_t n, const Query& query)
{
  const double few = stepsOf(make(n), query), some = stepsOf(make(4 * n), query), many = stepsOf(make(16 * n), query);
  EXPECT_LE(some, 6 * few + 1000) << name;
  EXPECT_LE(many, 6 * some + 1000) << name;
  EXPECT_LE(many, 25 * few + 1000) << name;
}

constexpr auto kOneContact = [](const Placed& a, const Placed& b, double clearance) {
  return nearestContacts(a, b, {clearance, 1});
};

TEST(PairWork, OneContactCostsWhatTheClosestPairDoes)
{
  // The clearance joins most pairs, of which one is asked for.
  const auto cubes = [](std::size_t n) { return HardPair{cube(n, 1), cube(n, 2), 0.5}; };
  expectLinear("one contact", cubes, 1000, kOneContact);
  const double closest =
      stepsOf(cubes(8000), [](const Placed& a, const Placed& b, double) { return closestPair(a, b, {}); });
  EXPECT_LT(stepsOf(cubes(8000), kOneContact), 1.5 * closest); // the closest pair asks leaves for their points, too
}

TEST(PairWork, OneContactOfBallsThatAllOverlap)
{
  // Gaps below 0 bound the search as well.
  const auto steps = [](std::size_t n) {
    test::Cloud a(cube(n, 1)), b(cube(n, 2));
    a.setRadii(std::vector<float>(n, 1.0f));
    b.setRadii(std::vector<float>(n, 1.0f));
    const SphereHierarchy of_a(a.view()), of_b(b.view());
    return stepsOf(nearestContacts(Placed(of_a), Placed(of_b), {0.5, 1}).work);
  };
  const double few = steps(1000), some = steps(4000), many = steps(16000);
  EXPECT_LE(some, 5 * few);
  EXPECT_LE(many, 5 * some);
}

constexpr auto kAny = [](const Placed& a, const Placed& b, double clearance) {
  return anyCollision(a, b, {clearance, {}});
};
constexpr auto kClosest = [](const Placed& a, const Placed& b, double) { return closestPair(a, b, {}); };
constexpr auto kFlags = [](const Placed& a, const Placed& b, double clearance) {
  return collisionFlags(a, b, {clearance, Flagged::both});
};
constexpr auto kWithin = [](const Placed& a, const Placed& b, double clearance) {
  return pairsWithin(a, b, {clearance, 1000});
};

/// Unit squares that face each other at this distance, points of one above the middles of the other's.
HardPair facingSheets(std::size_t n, double distance, double clearance)
{
  const double edge = 1.0 / std::sqrt(static_cast<double>(n));
  HardPair pair{sheet(n, 0, 0), sheet(n, 0.5, 0), clearance};
  for (auto* points : {&pair.a, &pair.b})
    for (Point3& p : *points) p = scaled(p, edge);
  for (Point3& p : pair.b) p[2] = distance;
  return pair;
}

TEST(PairWork, SheetsThatFaceEachOtherAtTheClearance)
{
  const auto near = [](std::size_t n) { return facingSheets(n, 1, 1); };
  expectLinear("any", near, 4000, kAny);
  expectLinear("closest", near, 4000, kClosest);
  expectLinear("one contact", near, 4000, kOneContact);
  expectLinear("pairs within", near, 4000, kWithin);
  // Ten times as far as they are wide, all pairs are within 1 % of the clearance: comparing all takes 16 times the
  // steps at 4 times the points, and took as many here.
  const auto far = [](std::size_t n) { return facingSheets(n, 10, 10); };
  EXPECT_LT(stepsOf(far(16000), kAny), 1e6);
  EXPECT_LT(stepsOf(far(16000), kFlags), 2e7);
}

TEST(PairWork, FlagsWithManyCandidatesOfBallsAreThoseOfPointsThatReachAsFar)
{
  HardPair pair = facingSheets(4000, 10, 10);
  test::Random random(19);
  for (Point3& p : pair.b) p[2] += random.uniform(-1e-3, 1e-3);
  test::Cloud a(pair.a), b(pair.b);
  const SphereHierarchy points_a(a.view()), points_b(b.view());
  const FlagsResult expected = collisionFlags({points_a}, {points_b}, {10.0, Flagged::both});
  EXPECT_GT(expected.colliding_a, 10u);
  EXPECT_LT(expected.colliding_a, 3990u);
  a.setRadii(std::vector<float>(pair.a.size(), 0.25f));
  b.setRadii(std::vector<float>(pair.b.size(), 0.25f));
  const SphereHierarchy balls_a(a.view()), balls_b(b.view());
  const FlagsResult found = collisionFlags({balls_a}, {balls_b}, {9.5, Flagged::both});
  EXPECT_EQ(found.a, expected.a);
  EXPECT_EQ(found.b, expected.b);
}

TEST(PairWork, FlagsWithManyCandidatesAreThoseOfSearchesForNeighbors)
{
  // So many candidates are left to each node that slabs are compared; searches for neighbours have none.
  test::Random random(9);
  for (const double rough : {1e-6, 1e-4, 1e-2}) {
    HardPair pair = facingSheets(16000, 10, 10);
    for (auto* points : {&pair.a, &pair.b})
      for (Point3& p : *points) p[2] += rough * random.uniform(-1, 1);
    const test::Cloud a(pair.a), b(pair.b);
    const SphereHierarchy of_a(a.view()), of_b(b.view());
    std::size_t most = 0;
    for (const double beyond : {-1.5 * rough, -0.5 * rough, 0.0, 2e-6}) {
      const FlagsResult flags = collisionFlags(of_a, of_b, {10 + beyond, Flagged::both});
      EXPECT_EQ(numbersOf(flags.a), flagAnyInRadius(of_b, a.view(), 10 + beyond)) << rough << ", " << beyond;
      EXPECT_EQ(numbersOf(flags.b), flagAnyInRadius(of_a, b.view(), 10 + beyond)) << rough << ", " << beyond;
      most = std::max(most, flags.colliding_a);
    }
    EXPECT_GT(most, 0u);
  }
}

TEST(PairWork, TinyBallWithinAShell)
{
  // The spheres of the shell's leaves are larger than the ball: its points tell what they do not.
  const auto ball = [](std::size_t n) {
    HardPair pair{shells(n, 1, 0), cube(n, 2), 0.9998};
    for (Point3& p : pair.b) p = scaled(p, 1e-4);
    return pair;
  };
  expectLinear("any", ball, 500, kAny);
  expectLinear("closest", ball, 500, kClosest);
  const auto swapped = [&ball](std::size_t n) {
    HardPair pair = ball(n);
    std::swap(pair.a, pair.b);
    return pair;
  };
  expectLinear("any, swapped", swapped, 500, kAny);
  expectLinear("closest, swapped", swapped, 500, kClosest);
  expectLinear("flags", ball, 500, kFlags);
}

/// The clouds at a clearance just below their distance, which only the search for it knows.
std::function<HardPair(std::size_t)> justApart(const std::function<HardPair(std::size_t)>& make)
{
  return [make](std::size_t n) {
    HardPair pair = make(n);
    const test::Cloud a(pair.a), b(pair.b);
    const SphereHierarchy of_a(a.view()), of_b(b.view());
    pair.clearance = closestPair(Placed(of_a), Placed(of_b, pair.pose_b), {}).distance * (1.0 - 1e-6);
    return pair;
  };
}

TEST(PairWork, ArcsAndPatchesFarForTheirSize)
{
  // Every point of the circle is as far from the axis: spheres about arcs are nearer by half of their lengths.
  const auto circle = justApart([](std::size_t n) { return HardPair{axis(n, 1), helix(n, 1, 0), 0.0}; });
  expectLinear("axis: any", circle, 1000, kAny);
  EXPECT_LT(stepsOf(circle(16000), kClosest), 7e5); // took 3.4e6; as many pairs as points are at the distance
  expectLinear("axis: flags", circle, 2000, kFlags);
  const auto rings = justApart([](std::size_t n) { return HardPair{helix(n, 1, 0), helix(n, 1, 0, 0.3, 0.5), 0.0}; });
  expectLinear("rings: any", rings, 1000, kAny);
  expectLinear("rings: closest", rings, 1000, kClosest);
  const auto sheets = justApart([](std::size_t n) { return facingSheets(n, 10, 10); });
  expectLinear("sheets: any", sheets, 4000, kAny);
}

TEST(PairWork, GrowsAsTheClouds)
{
  struct Named {
    const char* name;
    bool free; ///< else the search for any ends when it meets the first pair, sooner or later
    std::function<HardPair(std::size_t)> make;
  };
  const Named catalogue[] = {
      {"cubes", false,
       [](std::size_t n) {
         return HardPair{cube(n, 1), cube(n, 2), 0.01};
       }},
      {"sheets of unit spacing", true,
       [](std::size_t n) {
         return HardPair{sheet(n, 0, 0), sheet(n, 0.5, 10), 10};
       }},
      {"interlocking combs", true,
       [](std::size_t n) {
         return HardPair{comb(n, 0), comb(n, 0.5), 0.49};
       }},
      {"double helix", true,
       [](std::size_t n) {
         return HardPair{helix(n, 30, 0.05), helix(n, 30, 0.05, 0.5), 0.02};
       }},
      {"one place each", true,
       [](std::size_t n) {
         return HardPair{std::vector<Point3>(n, Point3{1, 2, 3}), std::vector<Point3>(n, Point3{1, 2, 4}), 0.5};
       }},
      {"strays on both sides", false, [](std::size_t n) {
         return HardPair{with(cube(n, 1), {{1e20, 1e20, 1e20}}), with(cube(n, 2), {{-1e20, 1e20, 1e20}}),
                         0.2 / std::cbrt(n)};
       }}};
  for (const Named& hard : catalogue) {
    if (hard.free) expectLinear((std::string(hard.name) + ": any").c_str(), hard.make, 4000, kAny);
    expectLinear((std::string(hard.name) + ": closest").c_str(), hard.make, 4000, kClosest);
    expectLinear((std::string(hard.name) + ": one contact").c_str(), hard.make, 4000, kOneContact);
    expectLinear((std::string(hard.name) + ": pairs within").c_str(), hard.make, 4000, kWithin);
    expectLinear((std::string(hard.name) + ": flags").c_str(), hard.make, 4000, kFlags);
  }
}

/// Balls about needles hold most of the scan: floats tell which needles are farther than the nearest pair, whichever
/// side they are on.
TEST(PairWork, PointsAmongNeedlesOfAFanAreSeldomDecidedExactly)
{
  test::Random random(3);
  const test::TestMesh fan = test::fanMesh(2000, 1.0, 0.3, true);
  std::vector<Point3> scan(2000);
  for (Point3& p : scan) p = {random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-0.5, 0.5)};
  const TrianglesView triangles = fan.trianglesView();
  const SphereHierarchy of_scan(viewOf(scan[0].data(), scan.size())), of_fan(viewOf(triangles));
  const Placed points(of_scan), needles(of_fan);
  for (const auto& [a, b] : {std::pair{points, needles}, {needles, points}}) {
    const DistanceResult closest = closestPair(a, b, {});
    ASSERT_GT(closest.distance, 0.0);
    EXPECT_LT(closest.work.exact_decisions, 1000u);
    const AnyResult free = anyCollision(a, b, {0.999 * closest.distance});
    EXPECT_EQ(free.verdict, Verdict::free);
    EXPECT_LT(free.work.exact_decisions, 50u);
    EXPECT_EQ(anyCollision(a, b, {closest.distance}).verdict, Verdict::colliding);
  }
}

} // namespace
} // namespace pcl_bsh
