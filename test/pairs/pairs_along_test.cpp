// SPDX-License-Identifier: BSD-3-Clause
// Pairs that come near each other on straight ways, against all pairs.
#include <pcl_bsh/pairs/pairs_along.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

constexpr double kNearly = 1e-5; ///< so much farther a pair may be, as a share of the reach

Eigen::Vector3d pointOf(const Cloud& cloud, std::uint32_t i)
{
  const Point3 p = cloud.view().point(i);
  return {p[0], p[1], p[2]};
}

/// Whether all pairs are found that come within the clearance, and none that stays away. @return how many
std::size_t expectSameAsAllPairs(const Cloud& cloud_a, const StraightWays& ways, const Cloud& cloud_b,
                                 const Eigen::Isometry3d& pose_b, double clearance)
{
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  const PairsWithin found = pairsAlong(a, ways, {b, pose_b}, {clearance});
  EXPECT_TRUE(found.complete);
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const PointPair pair : found.pairs) EXPECT_TRUE(pairs.emplace(pair.a, pair.b).second) << "twice";
  double largest = 0.0; // way of a place, for leaves have one
  for (std::uint32_t i = 0; i < cloud_a.view().count; ++i) largest = std::max(largest, pointOf(cloud_a, i).norm());
  const double spread = 2.0 * ways.turn.norm() * largest;
  std::size_t within = 0;
  for (std::uint32_t i = 0; i < cloud_a.view().count; ++i)
    for (std::uint32_t j = 0; j < cloud_b.view().count; ++j) {
      const Eigen::Vector3d way = ways.way(pointOf(cloud_a, i));
      const double least =
          leastOnWay(ways.start * pointOf(cloud_a, i) - pose_b * pointOf(cloud_b, j), way) - ways.stray;
      const bool is_found = pairs.count({i, j}) > 0;
      within += least <= clearance;
      if (least <= clearance) {
        EXPECT_TRUE(is_found) << i << ' ' << j << ": " << least;
      }
      if (is_found) {
        EXPECT_LE(least, clearance + spread + kNearly * (clearance + way.norm() + ways.stray));
      }
    }
  return within;
}

TEST(PairsAlong, TheLeastDistanceIsAtAnEndOrBetween)
{
  const Eigen::Vector3d way(2, 0, 0);
  EXPECT_EQ(leastOnWay({-0.5, 2, 0}, way), 2.0);
  EXPECT_EQ(leastOnWay({3, 4, 0}, way), 5.0);
  EXPECT_EQ(leastOnWay({-5, 4, 0}, way), 5.0);
  EXPECT_EQ(leastOnWay({3, 4, 0}, Eigen::Vector3d::Zero()), 5.0);
}

TEST(PairsAlong, AreThoseOfAllPairs)
{
  std::size_t within = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const double size = random.pick({0.01, 1.0, 100.0}), far = random.pick({0.0, 1.0, 1e5});
    const Cloud a(test::makePoints(random.pick(test::all_shapes), 150, size, random), {Scalar::float64, 0, 0});
    const Cloud b(test::makePoints(random.pick(test::all_shapes), 150, size, random), {Scalar::float64, 0, 0});
    const Eigen::Isometry3d pose_b = random.pose(size * far);
    StraightWays ways;
    ways.start = pose_b * random.pose(size);
    const Point3 shift = random.point([&] { return size * random.uniform(-1.0, 1.0); });
    ways.shift = random.chance(0.1) ? Eigen::Vector3d::Zero() : Eigen::Vector3d(shift[0], shift[1], shift[2]);
    if (random.chance(0.5)) ways.turn = random.uniform(0.002, 0.2) * random.rotation().toRotationMatrix();
    if (random.chance(0.5)) ways.stray = random.uniform(0.0, 0.1) * size;
    within += expectSameAsAllPairs(a, ways, b, pose_b, random.uniform(0.0, 0.1) * size);
  }
  EXPECT_GT(within, 5000u);
}

/// Ways that are too short for floats, down to those whose squares vanish, lead to a point exactly.
TEST(PairsAlong, FindTheEndsOfTheShortestWays)
{
  for (int power = -1070; power <= 0; ++power) {
    SCOPED_TRACE(power);
    const double length = std::ldexp(1.0, power);
    const Cloud a({{0, 0, 0}}, {Scalar::float64, 0, 0}), b({{length, 0, 0}}, {Scalar::float64, 0, 0});
    StraightWays ways;
    ways.shift = {length, 0, 0};
    EXPECT_EQ(
        pairsAlong(SphereHierarchy(a.view()), ways, {SphereHierarchy(b.view()), Eigen::Isometry3d::Identity()}, {0.0})
            .pairs.size(),
        1u);
  }
}

/// A crate's face beside a floor: on its way along the floor, few points come near those of the floor.
TEST(PairsAlong, PassOverWhatIsBesideTheWay)
{
  const auto sheet = [](int count, double spacing, double height) {
    std::vector<Point3> points;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) points.push_back({spacing * i, spacing * j, height});
    return Cloud(points, {Scalar::float64, 0, 0});
  };
  const Cloud face = sheet(60, 0.01, 0.0205), floor = sheet(12, 0.05, 0.0);
  StraightWays ways;
  ways.start.translation().x() = -0.015;
  ways.shift.x() = 0.03;
  const std::size_t within = expectSameAsAllPairs(face, ways, floor, Eigen::Isometry3d::Identity(), 0.021);
  EXPECT_GT(within, 0u);
  const SphereHierarchy a(face.view()), b(floor.view());
  EXPECT_LT(5 * within, pairsWithin({a}, {b}, {0.036}).pairs.size());
}

/// A crate's face that leaves a floor, or is led along it: leaves are compared only where they face each other.
TEST(PairsAlong, CompareFewLeavesOfFacingSheets)
{
  const auto sheet = [](int count, double spacing, double height) {
    std::vector<Point3> points;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) points.push_back({spacing * i, spacing * j, height + 0.004 * i / count});
    return Cloud(points, {Scalar::float64, 0, 0});
  };
  const Cloud face = sheet(120, 0.01, 0.03), floor = sheet(40, 0.03, 0.0);
  const SphereHierarchy a(face.view()), b(floor.view());
  const Eigen::Vector3d up(0.2, 0, 0.2), aside(0.1, 0, 0);
  for (const Eigen::Vector3d& way : {up, aside}) {
    StraightWays ways;
    ways.shift = way;
    EXPECT_GT(pairsWithin({a}, {b}, {0.03 + 0.5 * way.norm()}).work.leaf_pairs, 2000u);
    const PairsWithin found = pairsAlong(a, ways, {b}, {0.029});
    EXPECT_EQ(found.pairs.size(), 0u);
    EXPECT_LT(found.work.leaf_pairs, 10u) << way;
  }
}

/// Layers that are thick beside the clearance, led along each other: only few points meet on the way.
TEST(PairsAlong, FindPointsOfThickLayers)
{
  std::size_t within = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto layer = [&] {
      std::vector<Point3> points;
      for (int i = 0; i < 1000; ++i)
        points.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.03, 0.03)});
      return Cloud(points, {Scalar::float64, 0, 0});
    };
    const Cloud a = layer(), b = layer();
    const Eigen::Isometry3d pose_b = random.pose(10.0);
    StraightWays ways;
    ways.start = pose_b * Eigen::Translation3d(0, -0.1, random.uniform(0.03, 0.06)) *
                 Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d::UnitZ());
    ways.shift = pose_b.linear() * Eigen::Vector3d(random.uniform(-0.4, 0.4), 0.2, random.uniform(0, 0.02));
    within += expectSameAsAllPairs(a, ways, b, pose_b, 0.01);
  }
  EXPECT_GT(within, 500u);
}

/// The t at which a point first comes within the clearance of another; 2: it does not.
double meetingOf(const Eigen::Vector3d& from, const Eigen::Vector3d& way, double clearance)
{
  if (from.norm() <= clearance) return 0.0;
  if (!(leastOnWay(from, way) <= clearance)) return 2.0;
  const double a = way.squaredNorm(), b = from.dot(way), c = from.squaredNorm() - clearance * clearance;
  return std::min(1.0, c / (std::sqrt(std::max(0.0, b * b - a * c)) - b));
}

/// Ways that end at the first meeting so far: whatever the order, the first of all is found, and less is compared.
TEST(PairsAlong, FindTheFirstMeetingOfAll)
{
  std::size_t met = 0;
  std::uint64_t compared = 0, of_all = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Cloud cloud_a(test::makePoints(random.pick(test::all_shapes), 300, 1.0, random), {Scalar::float64, 0, 0});
    const Cloud cloud_b(test::makePoints(random.pick(test::all_shapes), 300, 1.0, random), {Scalar::float64, 0, 0});
    const Eigen::Isometry3d pose_b = random.pose(10.0);
    StraightWays ways;
    ways.start = pose_b * random.pose(1.0);
    const Point3 shift = random.point([&] { return random.uniform(-2, 2); });
    ways.shift = Eigen::Vector3d(shift[0], shift[1], shift[2]);
    if (random.chance(0.5)) ways.turn = random.uniform(0.001, 0.5) * random.rotation().toRotationMatrix();
    const double clearance = random.uniform(0.0, 0.1);
    const auto meeting = [&](PointPair pair) {
      const Eigen::Vector3d p = pointOf(cloud_a, pair.a);
      return meetingOf(ways.start * p - pose_b * pointOf(cloud_b, pair.b), ways.way(p), clearance);
    };
    double first = 2.0, found = 2.0;
    for (std::uint32_t i = 0; i < cloud_a.view().count; ++i)
      for (std::uint32_t j = 0; j < cloud_b.view().count; ++j) first = std::min(first, meeting({i, j}));
    const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
    const auto end_of_ways = [&](PointPair pair) { return found = std::min(found, meeting(pair)); };
    const PairsWithin least =
        pairsAlong(a, ways, {b, pose_b}, {clearance}, std::numeric_limits<std::uint64_t>::max(), end_of_ways);
    EXPECT_TRUE(least.complete);
    EXPECT_EQ(found, first);
    met += first <= 1.0;
    compared += least.work.leaf_pairs;
    of_all += pairsAlong(a, ways, {b, pose_b}, {clearance}).work.leaf_pairs;
  }
  EXPECT_GT(met, 100u);
  EXPECT_LT(met, 290u);
  EXPECT_LT(5 * compared, 4 * of_all);
}

TEST(PairsAlong, AreNotCompleteWhereThereAreMore)
{
  const Cloud cloud(std::vector<Point3>(20, Point3{0, 0, 0}), {Scalar::float64, 0, 0});
  const SphereHierarchy a(cloud.view());
  const PairsWithin found = pairsAlong(a, {}, {a}, {0.0, 399});
  EXPECT_FALSE(found.complete);
  EXPECT_EQ(found.pairs.size(), 399u);
  EXPECT_TRUE(pairsAlong(a, {}, {a}, {0.0, 400}).complete);
  EXPECT_TRUE(pairsAlong(a, {}, {a}, {0.0}, 1).complete);
  EXPECT_FALSE(pairsAlong(a, {}, {a}, {0.0}, 0).complete);
}

} // namespace
} // namespace pcl_bsh
