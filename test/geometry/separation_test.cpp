// SPDX-License-Identifier: BSD-3-Clause
// Distances of corners at rest against exact ones; of corners that move against those at many instants.
#include <pcl_bsh/geometry/triangle/separation.h>
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

using test::Random;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

/// A point, a fat triangle, a needle, a segment, or a triangle on a lattice, about `center`.
Corners anyCorners(Random& random, const Point3& center)
{
  const auto beside = [&](const Point3& p, double reach) {
    return random.point([&, k = std::size_t{0}]() mutable { return p[k++ % 3] + reach * random.uniform(-1, 1); });
  };
  const auto on_lattice = [&] { return random.point([&] { return 0.25 * random.integer(-4, 4); }); };
  const Point3 p = beside(center, 1);
  switch (random.integer(0, 4)) {
  case 0:
    return Corners::of(p);
  case 1:
    return Corners::of(Triangle3{p, beside(p, 1), beside(p, 1)});
  case 2:
    return Corners::of(Triangle3{p, beside(p, 1e-5), beside(p, 1)});
  case 3: {
    const Point3 q = beside(p, 1);
    return Corners::of(Triangle3{p, q, q});
  }
  default:
    return Corners::of(Triangle3{on_lattice(), on_lattice(), on_lattice()});
  }
}

double exactDistance(const Corners& a, const Corners& b)
{
  const TriangleDistance distance(identity, identity);
  if (a.count == 1 && b.count == 1) return ExactDistance(identity, identity).gap({a.at[0], b.at[0]});
  if (a.count == 1) return distance.distance(a.at[0], b.at);
  if (b.count == 1) return distance.distance(b.at[0], a.at);
  return distance.distance(a.at, b.at);
}

TEST(Separation, HoldsTheDistance)
{
  Random random(5);
  double widest = 0.0;
  int meeting = 0;
  for (int i = 0; i < 20000; ++i) {
    const double far = random.chance(0.2) ? 100.0 : 0.0;
    const Corners a = anyCorners(random, {far, 0, -far}), b = anyCorners(random, {far, random.uniform(-1, 1), -far});
    const Separation found = separationOf(a, b);
    const double exact = exactDistance(a, b);
    ASSERT_LE(found.low, exact) << i;
    ASSERT_GE(found.high, exact) << i;
    ASSERT_LE(found.high, exact + 1e-9) << i;
    if (exact > 1e-3) widest = std::max(widest, found.high - found.low);
    meeting += exact == 0.0;
  }
  EXPECT_LT(widest, 1e-8);
  EXPECT_GT(meeting, 500);
}

MovingCorners anyMotion(Random& random)
{
  const Corners from = anyCorners(random, {0, 0, 0});
  MovingCorners moving{from.at, {}, {}, from.count};
  const Point3 shift = random.point([&] { return random.uniform(-2, 2); });
  const double turn = random.chance(0.5) ? 0.3 : 0.0, bend = random.chance(0.5) ? 0.2 : 0.0;
  for (std::uint32_t i = 0; i < from.count; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      moving.way[i][k] = shift[k] + turn * random.uniform(-1, 1);
      moving.bow[i][k] = bend * random.uniform(-1, 1);
    }
  return moving;
}

/// Along the very direction between two places, where only what is taken off for rounding keeps the bound below.
TEST(MovingCorners, AreNoNearerThanIsSaidHoweverFarTheyBeginGoAndBend)
{
  using Real = long double;
  Random random(17);
  constexpr double sizes[] = {0.0, 1.0, 1e4};
  for (int i = 0; i < 4000; ++i) {
    const auto any = [&] {
      const double size = random.pick(sizes);
      return random.point([&] { return size * random.uniform(-1, 1); });
    };
    MovingCorners moving[2] = {};
    for (MovingCorners& one : moving) one = {{any()}, {any()}, {any()}, 1};
    const double s = random.uniform(0, 1);
    Real apart[3], squared = 0.0L;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = [&](const MovingCorners& one) {
        return one.from[0][axis] + s * Real(one.way[0][axis]) + 4.0L * s * (1.0L - s) * one.bow[0][axis];
      };
      apart[axis] = at(moving[0]) - at(moving[1]);
      squared += apart[axis] * apart[axis];
    }
    const Real distance = std::sqrt(squared);
    if (distance == 0.0L) continue;
    Point3 direction;
    for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = static_cast<double>(apart[axis] / distance);
    const double least = MovingPair(moving[0], moving[1]).leastApart(direction, s, s);
    EXPECT_LE(least, distance) << i;
    EXPECT_GE(least, distance - 1e-9L) << i;
  }
}

TEST(MovingCorners, AreNoNearerThanTheDirectionSays)
{
  Random random(6);
  for (int i = 0; i < 3000; ++i) {
    const MovingCorners a = anyMotion(random), b = anyMotion(random);
    const double begin = random.uniform(0, 0.9), end = random.uniform(begin, 1);
    const Separation middle = separationOf(a.at(0.5 * (begin + end)), b.at(0.5 * (begin + end)));
    const double least = MovingPair(a, b).leastApart(middle.direction, begin, end);
    for (int k = 0; k <= 20; ++k) {
      const double s = begin + (end - begin) * k / 20;
      ASSERT_LE(least, separationOf(a.at(s), b.at(s)).high) << i << " at " << s;
    }
  }
}

TEST(Approach, IsThatOfManyInstants)
{
  Random random(7);
  constexpr double resolution = 1e-4;
  constexpr int instants = 400;
  int contacts = 0, passed = 0, later = 0;
  for (int i = 0; i < 600; ++i) {
    const MovingCorners a = anyMotion(random), b = anyMotion(random);
    const double near_enough = random.uniform(0, 0.6);
    double least = std::numeric_limits<double>::infinity(), first = 2.0;
    double step = 0.0;
    for (const MovingCorners* moving : {&a, &b})
      for (std::uint32_t k = 0; k < moving->count; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
          step += (std::abs(moving->way[k][axis]) + 4 * std::abs(moving->bow[k][axis])) / instants;
    for (int k = 0; k <= instants; ++k) {
      const double s = static_cast<double>(k) / instants, high = separationOf(a.at(s), b.at(s)).high;
      least = std::min(least, high);
      if (high <= near_enough - resolution) first = std::min(first, s);
    }
    for (const bool nearest : {true, false}) {
      const Approach found = approachOf(a, b, near_enough, resolution, nearest);
      if (least <= near_enough - resolution) {
        ASSERT_TRUE(found.contact) << i;
        ASSERT_LE(found.enter, first + 1e-12) << i;
        ASSERT_LE(separationOf(a.at(found.enter), b.at(found.enter)).high, near_enough) << i;
      }
      if (least > near_enough + step) {
        ASSERT_FALSE(found.contact) << i;
      }
      if (!found.contact || !nearest) continue;
      ASSERT_LE(found.distance, least + resolution) << i;
      ASSERT_GE(found.distance, least - step) << i;
      ASSERT_EQ(found.distance, separationOf(a.at(found.at), b.at(found.at)).high) << i;
    }
    const Approach whole = approachOf(a, b, near_enough, resolution, false);
    for (const double early_enough : {0.0, 0.5, random.uniform(0, 1)}) {
      const Approach found = approachOf(a, b, near_enough, resolution, false, early_enough);
      ASSERT_EQ(found.contact, whole.contact) << i;
      if (!found.contact) continue;
      later += found.enter > whole.enter;
      ASSERT_GE(found.enter, whole.enter) << i;
      if (whole.enter < early_enough) {
        ASSERT_EQ(found.enter, whole.enter) << i;
      }
      ASSERT_LE(separationOf(a.at(found.enter), b.at(found.enter)).high, near_enough) << i;
    }
    ++(least <= near_enough ? contacts : passed);
  }
  EXPECT_GT(contacts, 100);
  EXPECT_GT(passed, 50);
  EXPECT_GT(later, 50);
}

/// Across a face, however small or large that is.
TEST(Separation, OfAFaceOfAnySizeIsAcrossIt)
{
  for (const double unit : {1.0, 1e-30, 1e-79, 1e-82, 1e-100, 1e-120, 1e30}) {
    SCOPED_TRACE(unit);
    const auto sized = [unit](Triangle3 t) {
      for (Point3& p : t) p = {unit * p[0], unit * p[1], unit * p[2]};
      return Corners::of(t);
    };
    const Corners a = sized({{{1, 1, 1}, {2, 2, 3}, {0, 2, 3}}}), b = sized({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}});
    EXPECT_NEAR(faceBetween(a, b, 0.5 * unit)[2], 1.0, 1e-12);
    const Separation apart = separationOf(a, b);
    EXPECT_NEAR(apart.direction[2], 1.0, 1e-12);
    EXPECT_NEAR(apart.high / unit, 1.0, 1e-9);
    const Corners pierced = sized({{{1, 1, -1}, {1, 1, 1}, {2, 1, 1}}});
    EXPECT_LE(separationOf(pierced, b).high, 1e-12 * unit);
  }
}

} // namespace
} // namespace pcl_bsh
