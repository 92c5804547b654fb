// SPDX-License-Identifier: BSD-3-Clause
// Flags of points with uncertainties of their own, where whole nodes are settled by the extremes of theirs: as
// colliding, as free, as undecided.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/update.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Shape;

/// How uncertainties spread over a cloud.
enum class Spread { none, zeros, alike, even, octaves, one_known, one_unknown, lattice };
constexpr Spread kSpreads[] = {Spread::none,    Spread::zeros,     Spread::alike,       Spread::even,
                               Spread::octaves, Spread::one_known, Spread::one_unknown, Spread::lattice};

std::vector<float> lengths(Spread spread, std::size_t count, double scale, Random& random)
{
  std::vector<float> own(spread == Spread::none ? 0 : count);
  const auto special = static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1));
  for (std::size_t i = 0; i < own.size(); ++i) {
    double length = 0.0;
    switch (spread) {
    case Spread::none:
    case Spread::zeros:
      break;
    case Spread::alike:
      length = scale / 8;
      break;
    case Spread::even:
      length = scale * random.uniform(0, 0.2);
      break;
    case Spread::octaves: // by a million within a leaf
      length = scale * std::pow(10.0, random.uniform(-6, 0));
      break;
    case Spread::one_known:
      length = i == special ? 0.0 : scale / 2;
      break;
    case Spread::one_unknown:
      length = i == special ? 2 * scale : 0.0;
      break;
    case Spread::lattice:
      length = scale * random.integer(0, 8) / 16;
      break;
    }
    own[i] = static_cast<float>(length);
  }
  return own;
}

/// Two clouds and a clearance that is the reach of one of their pairs, or nearly: nodes are small beside it.
struct Edge {
  explicit Edge(std::uint64_t seed) : random(seed)
  {
    const bool is_lattice = random.chance(0.3);
    const double size = std::pow(2.0, random.integer(-4, 1));
    const Shape shapes[] = {Shape::uniform, Shape::sphere,   Shape::plane,
                            Shape::line,    Shape::clusters, Shape::duplicates};
    const auto points = [&](double x) {
      const Shape shape = is_lattice ? Shape::grid : random.pick(shapes);
      std::vector<Point3> made =
          test::makePoints(shape, static_cast<std::size_t>(random.integer(1, 150)), size, random);
      for (Point3& p : made) p[0] += x;
      return made;
    };
    const double origin = random.chance(0.3) ? 5e5 : 0.0; // as of coordinates on a map
    const Scalar scalar = origin > 0.0 || random.chance(0.5) ? Scalar::float64 : Scalar::float32;
    a = Cloud(points(origin), {scalar});
    b = Cloud(points(origin + 1.0), {scalar});
    const double scale = random.pick({0.25, 1.0, 4.0});
    a.setUncertainties(random.chance(0.3) ? scale / 16 : 0.0,
                       lengths(random.pick(kSpreads), a.view().count, scale, random));
    b.setUncertainties(random.chance(0.3) ? scale / 32 : 0.0,
                       lengths(random.pick(kSpreads), b.view().count, scale, random));
    if (random.chance(0.2)) b.setRadii(lengths(Spread::even, b.view().count, 0.1, random));
    if (!is_lattice && origin == 0.0) pose = random.pose(0.5);
    const auto i = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(a.view().count) - 1));
    const auto j = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(b.view().count) - 1));
    const Point3 p = a.view().point(i), q = b.view().point(j);
    const double distance = (Eigen::Vector3d(p[0], p[1], p[2]) - pose * Eigen::Vector3d(q[0], q[1], q[2])).norm();
    const double radius = b.view().radius(j);
    const double off =
        a.view().uncertainty + a.view().ownUncertainty(i) + b.view().uncertainty + b.view().ownUncertainty(j);
    clearance = std::max(0.0, random.chance(0.5) ? distance - radius + off : distance - radius - off);
    const int steps = random.integer(-2, 2);
    for (int k = 0; k < std::abs(steps); ++k)
      clearance = std::max(0.0, std::nextafter(clearance, steps < 0 ? 0.0 : 1e9));
  }

  Random random;
  Cloud a{{}}, b{{}};
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double clearance = 0.0;
};

void expectBruteForce(const SphereHierarchy& a, const Placed& b, const FlagsRequest& request)
{
  const FlagsResult found = collisionFlags({a}, b, request);
  const FlagsResult truth = brute_force::collisionFlags({a}, b, request);
  ASSERT_EQ(found.a, truth.a);
  ASSERT_EQ(found.b, truth.b);
  ASSERT_EQ(found.colliding_a, truth.colliding_a);
  ASSERT_EQ(found.undecided_a, truth.undecided_a);
  ASSERT_EQ(found.colliding_b, truth.colliding_b);
  ASSERT_EQ(found.undecided_b, truth.undecided_b);
}

TEST(OwnUncertainties, AtTheEdgesOfPairs)
{
  std::size_t flags[3] = {};
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    const Edge edge(seed);
    const SphereHierarchy a(edge.a.view()), b(edge.b.view());
    if (seed % 2 == 0) { // trees, not lists of points
      a.buildAll();
      b.buildAll();
    }
    const FlagsRequest request{edge.clearance, Flagged::both, seed % 5 == 0 ? 2u : 1u};
    expectBruteForce(a, {b, edge.pose}, request);
    if (HasFatalFailure()) return;
    EXPECT_TRUE(a.validate().none());
    EXPECT_TRUE(b.validate().none());
    for (const Verdict flag : collisionFlags({a}, {b, edge.pose}, request).a) ++flags[test::numberOf(flag)];
  }
  for (const std::size_t count : flags) EXPECT_GT(count, 1000u);
}

/// Nodes know the points as they are now.
TEST(OwnUncertainties, FollowWhatChanges)
{
  std::size_t flags[3] = {};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Edge edge(1000 + seed);
    edge.b.setRadii({});
    const FlagsRequest request{edge.clearance, Flagged::both};
    SphereHierarchy a(edge.a.view()), b(edge.b.view());
    for (int change = 0; change < 6; ++change) {
      a.buildAll();
      b.buildAll();
      expectBruteForce(a, {b, edge.pose}, request);
      if (HasFatalFailure()) return;
      for (const Verdict flag : collisionFlags({a}, {b, edge.pose}, request).b) ++flags[test::numberOf(flag)];
      Cloud& cloud = change % 2 == 0 ? edge.a : edge.b;
      SphereHierarchy& hierarchy = change % 2 == 0 ? a : b;
      cloud.setUncertainties(0.0, lengths(edge.random.pick(kSpreads), cloud.view().count, 1.0, edge.random));
      if (change < 3) {
        hierarchy.refit(cloud.view());
      }
      else {
        std::vector<std::int32_t> all(cloud.view().count); // those at one place have to be told apart again
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
        HierarchyUpdate update(hierarchy, all.data(), all.size());
        update.commit(cloud.view());
      }
      ASSERT_TRUE(hierarchy.validate().none());
    }
  }
  for (const std::size_t count : flags) EXPECT_GT(count, 500u);
}

TEST(OwnUncertainties, LessThanExactClaimsNothingFalse)
{
  std::size_t decided = 0, withheld = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    const Edge edge(2000 + seed);
    const SphereHierarchy a(edge.a.view()), b(edge.b.view());
    FlagsRequest request{edge.clearance, Flagged::both};
    const FlagsResult truth = brute_force::collisionFlags({a}, {b, edge.pose}, request);
    for (const Accuracy& accuracy : {Accuracy::level(1), Accuracy::level(2), Accuracy::nodePairs(30),
                                     Accuracy::nodePairs(300), Accuracy::time(1.0)}) {
      request.accuracy = accuracy;
      const FlagsResult found = collisionFlags({a}, {b, edge.pose}, request);
      for (std::size_t i = 0; i < found.a.size(); ++i) {
        if (found.a[i] != Verdict::undecided) {
          ASSERT_EQ(found.a[i], truth.a[i]) << accuracy.text() << ", point " << i;
        }
        ++(found.a[i] == truth.a[i] ? decided : withheld);
      }
    }
  }
  EXPECT_GT(decided, 10000u);
  EXPECT_GT(withheld, 1000u);
}

/// A rough sheet of points, one unit apart.
std::vector<Point3> sheet(int side, double x, double z, Random& random)
{
  std::vector<Point3> points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      points.push_back(
          {x + i + random.uniform(-0.3, 0.3), j + random.uniform(-0.3, 0.3), z + random.uniform(-0.3, 0.3)});
  return points;
}

/// Flags of two sheets that overlap in part, at 20 times their spacing.
FlagsResult flagsOfSheets(double of_all, double own, double clearance = 20.0)
{
  Random random(5);
  Cloud a(sheet(150, 0, 0, random)), b(sheet(150, 110, 1, random));
  const auto drawn = [&] {
    std::vector<float> each(own > 0.0 ? a.view().count : 0);
    for (float& length : each) length = static_cast<float>(random.uniform(0, own));
    return each;
  };
  a.setUncertainties(of_all, drawn());
  b.setUncertainties(of_all, drawn());
  const SphereHierarchy of_a(a.view()), of_b(b.view());
  of_a.buildAll();
  of_b.buildAll();
  const FlagsRequest request{clearance, Flagged::both};
  collisionFlags({of_a}, {of_b}, request); // fits what queries share
  return collisionFlags({of_a}, {of_b}, request);
}

TEST(OwnUncertainties, CostLittleWhereNodesSettleWhole)
{
  const Work plain = flagsOfSheets(0, 0).work;
  const FlagsResult one_length = flagsOfSheets(1, 0), of_each = flagsOfSheets(0, 2);
  const auto expectAtMost = [&](const FlagsResult& found, double node_pairs, double leaf_pairs) {
    EXPECT_GT(found.undecided_a, 500u);
    EXPECT_LE(static_cast<double>(found.work.node_pairs), node_pairs * static_cast<double>(plain.node_pairs));
    EXPECT_LE(static_cast<double>(found.work.leaf_pairs), leaf_pairs * static_cast<double>(plain.leaf_pairs));
    EXPECT_LT(found.work.exact_decisions, 5u);
  };
  expectAtMost(one_length, 1.8, 1.8);
  expectAtMost(of_each, 2.3, 3.0);
}

TEST(OwnUncertainties, CostNothingWhereNoneIsGiven)
{
  Random random(5);
  const Cloud a(sheet(40, 0, 0, random)), b(sheet(40, 0, 1, random));
  const SphereHierarchy of_a(a.view()), of_b(b.view());
  of_a.buildAll();
  of_b.buildAll();
  const std::size_t bytes = of_a.statistics().bytes;
  collisionFlags({of_a}, {of_b}, {0.5, Flagged::both});
  EXPECT_EQ(of_a.statistics().bytes, bytes);
}

} // namespace
} // namespace pcl_bsh
