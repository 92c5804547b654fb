// SPDX-License-Identifier: BSD-3-Clause
// Against the definition in rational numbers, on random, tied, degenerate and thin triangles, as they are and turned;
// and how often each stage decides.
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include "triangle_oracle.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace pcl_bsh {
namespace {

using Eigen::Isometry3d;
using test::posed;
using test::Random;
using test::Rational;
using test::TriangleShape;
using Stages = TriangleDistance::Stages;

const Isometry3d identity = Isometry3d::Identity();
constexpr double infinity = std::numeric_limits<double>::infinity();

int signOf(const Rational& x)
{
  return x.sign();
}

/// No double is nearer to the root of the square; of two as near, this one is even.
void expectNearest(double rounded, const Rational& squared)
{
  ASSERT_TRUE(std::isfinite(rounded));
  const bool even = (std::bit_cast<std::uint64_t>(rounded) & 1) == 0;
  const Rational above = (Rational(rounded) + Rational(std::nextafter(rounded, infinity))) / 2;
  const int over = signOf(squared - above * above);
  EXPECT_TRUE(over < 0 || (over == 0 && even)) << std::hexfloat << rounded;
  if (rounded == 0.0) return;
  const Rational below = (Rational(rounded) + Rational(std::nextafter(rounded, 0.0))) / 2;
  const int under = signOf(squared - below * below);
  EXPECT_TRUE(under > 0 || (under == 0 && even)) << std::hexfloat << rounded;
}

/// With clearances at the distance, next to it, and anywhere.
template <class A>
void checkEverything(const Isometry3d& pose_a, const Isometry3d& pose_b, const A& a, const Triangle3& b, Random& random,
                     Stages& decisions, Stages& roundings)
{
  const TriangleDistance distance(pose_a, pose_b);
  const Rational squared = test::squaredDistance(posed(pose_a, a), posed(pose_b, b));
  const double length = distance.distance(a, b, &roundings);
  expectNearest(length, squared);
  const TriangleDistance::Enclosure enclosure = distance.enclose(a, b);
  if (std::isfinite(enclosure.high)) {
    EXPECT_GE(signOf(Rational(enclosure.high) * Rational(enclosure.high) - squared), 0);
    if (enclosure.low > 0) {
      EXPECT_LE(signOf(Rational(enclosure.low) * Rational(enclosure.low) - squared), 0);
    }
  }
  if constexpr (std::is_same_v<A, Triangle3>) // what is beyond a reach need not be known well
    for (const double reach : {0.0, 0.5 * length, 0.99 * length, std::nextafter(length, 0.0), length}) {
      const double low = distance.enclose(a, b, reach).low;
      EXPECT_TRUE(low <= 0 || signOf(Rational(low) * Rational(low) - squared) <= 0) << std::hexfloat << reach;
    }
  for (const double clearance : {length, std::nextafter(length, infinity), std::nextafter(length, 0.0), 0.0,
                                 length * random.uniform(0.5, 1.5), infinity}) {
    const int expected = clearance == infinity ? -1 : signOf(squared - Rational(clearance) * Rational(clearance));
    EXPECT_EQ(distance.compare(a, b, clearance, &decisions), expected) << std::hexfloat << clearance;
  }
}

Isometry3d poseOf(int kind, Random& random)
{
  Isometry3d pose = identity;
  if (kind == 1) pose.pretranslate(Eigen::Vector3d(513449.75, 5402650.25, -0.125));
  if (kind == 2) pose = random.pose(1.0);
  if (kind == 3) pose = random.pose(1e6);
  if (kind == 4) { // as far from rigid as poses may be
    pose = random.pose(1.0);
    pose.linear() *= 1.0 + 4e-7;
  }
  return pose;
}

Point3 nearTo(const Triangle3& t, double reach, Random& random)
{
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  Point3 p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = t[0][k] + u * (t[1][k] - t[0][k]) + v * (t[2][k] - t[0][k]) + reach * random.uniform(-1, 1);
  return p;
}

void report(const std::string& what, const Stages& stages)
{
  std::printf("  %s: %llu in double, %llu in long numbers, %llu in integers\n", what.c_str(),
              static_cast<unsigned long long>(stages.doubles), static_cast<unsigned long long>(stages.long_numbers),
              static_cast<unsigned long long>(stages.integers));
}

TEST(TriangleDistance, OfPointsEqualsTheDefinition)
{
  Random random(301);
  Stages decisions, roundings;
  for (const TriangleShape shape : test::kTriangleShapes)
    for (int kind = 0; kind < 5; ++kind)
      for (int i = 0; i < 60; ++i) {
        const double size = std::ldexp(random.uniform(1, 2), random.integer(-6, 6));
        const Isometry3d pose = poseOf(kind, random), other = random.chance(0.5) ? pose : identity;
        const Triangle3 b = test::triangleOf(shape, size, random);
        Point3 p = random.chance(0.5) ? test::cornerOf(shape, size, random)
                                      : nearTo(b, size * std::pow(10.0, -random.integer(0, 9)), random);
        if (random.chance(0.1)) p = b[static_cast<std::size_t>(random.integer(0, 2))];
        SCOPED_TRACE(testing::PrintToString(static_cast<int>(shape)) + " " + testing::PrintToString(kind));
        const TriangleDistance distance(pose, other);
        const Rational squared = test::squaredDistance(posed(pose, p), posed(other, b));
        const double length = distance.distance(p, b, &roundings);
        expectNearest(length, squared);
        const auto enclosure = distance.enclose(p, b);
        EXPECT_GE(signOf(Rational(enclosure.high) * Rational(enclosure.high) - squared), 0);
        if (enclosure.low > 0) {
          EXPECT_LE(signOf(Rational(enclosure.low) * Rational(enclosure.low) - squared), 0);
        }
        for (const double clearance : {length, std::nextafter(length, infinity), std::nextafter(length, 0.0), 0.0}) {
          const int expected = signOf(squared - Rational(clearance) * Rational(clearance));
          EXPECT_EQ(distance.compare(p, b, clearance, 0.0, &decisions), expected) << std::hexfloat << clearance;
          const double radius = clearance * random.uniform(0, 1), rest = clearance - radius;
          const Rational reach = Rational(rest) + Rational(radius);
          EXPECT_EQ(distance.compare(p, b, rest, radius), signOf(squared - reach * reach));
        }
        EXPECT_EQ(distance.compare(p, b, infinity), -1);
      }
  report("points, clearances next to the distance", decisions);
  report("points, distances", roundings);
  EXPECT_GT(decisions.doubles, 0u);
  EXPECT_GT(decisions.long_numbers, 0u);
  EXPECT_GT(decisions.integers, 0u);
}

TEST(TriangleDistance, OfTrianglesEqualsTheDefinition)
{
  Random random(302);
  Stages decisions, roundings;
  for (const TriangleShape shape : test::kTriangleShapes)
    for (const TriangleShape other_shape : test::kTriangleShapes)
      for (int kind = 0; kind < 5; ++kind)
        for (int i = 0; i < 6; ++i) {
          const double size =
              shape == TriangleShape::lattice ? 0x1p-8 : std::ldexp(random.uniform(1, 2), random.integer(-3, 3));
          const Isometry3d pose = poseOf(kind, random), other = random.chance(0.5) ? pose : identity;
          Triangle3 a = test::triangleOf(shape, size, random), b = test::triangleOf(other_shape, size, random);
          if (random.chance(0.4)) { // near each other, and with a corner in common
            const Point3 at = nearTo(b, random.chance(0.5) ? 0.0 : 1e-3 * size, random), from = a[0];
            for (Point3& corner : a)
              for (std::size_t k = 0; k < 3; ++k) corner[k] += at[k] - from[k];
          }
          if (random.chance(0.1)) a[1] = b[2];
          SCOPED_TRACE(testing::PrintToString(static_cast<int>(shape)) + " " +
                       testing::PrintToString(static_cast<int>(other_shape)) + " " + testing::PrintToString(kind));
          checkEverything(pose, other, a, b, random, decisions, roundings);
        }
  report("triangles, clearances next to the distance", decisions);
  report("triangles, distances", roundings);
  EXPECT_GT(decisions.doubles, 0u);
  EXPECT_GT(decisions.long_numbers, 0u);
  EXPECT_GT(decisions.integers, 0u);
}

TEST(TriangleDistance, MeetingTrianglesAreAtZero)
{
  const TriangleDistance distance(identity, identity);
  const Triangle3 floor = {{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}};
  EXPECT_EQ(distance.distance(Triangle3{{{2, 2, -1}, {2, 2, 1}, {9, 9, 5}}}, floor), 0.0);     // pierced by an edge
  EXPECT_EQ(distance.distance(floor, Triangle3{{{2, 2, -1}, {2, 2, 1}, {9, 9, 5}}}), 0.0);     // piercing
  EXPECT_EQ(distance.distance(Triangle3{{{2, 2, -1e-18}, {2, 2, 1}, {3, 3, 1}}}, floor), 0.0); // by next to nothing
  EXPECT_EQ(distance.distance(Triangle3{{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}, floor), 0.0);      // inside, in the plane
  EXPECT_EQ(distance.distance(floor, Triangle3{{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}), 0.0);      // around it
  EXPECT_EQ(distance.distance(Triangle3{{{4, 4, 0}, {9, 9, 0}, {9, 9, 5}}}, floor), 0.0);      // touching an edge
  EXPECT_EQ(distance.distance(Triangle3{{{8, 0, 0}, {9, 0, 0}, {9, 0, 5}}}, floor), 0.0);      // a corner in common
  EXPECT_EQ(distance.distance(Triangle3{{{1, 1, -1}, {1, 1, -1}, {1, 1, 1}}}, floor), 0.0);    // a segment through it
  EXPECT_EQ(distance.distance(Triangle3{{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}, floor), 0.0);      // a point of it
  EXPECT_EQ(distance.compare(Triangle3{{{2, 2, 3}, {3, 2, 3}, {2, 3, 4}}}, floor, 3.0), 0);    // just as far
  EXPECT_EQ(distance.compare(Triangle3{{{2, 2, 3}, {3, 2, 3}, {2, 3, 4}}}, floor, std::nextafter(3.0, 0.0)), 1);
}

TEST(TriangleDistance, TakesNumbersOfAnyMagnitude)
{
  Random random(303);
  for (const int exponent : {-1074, -1000, -600, -300, 300, 500}) {
    for (int i = 0; i < 10; ++i) {
      const auto corner = [&] { return random.point([&] { return std::ldexp(random.integer(-100, 100), exponent); }); };
      const Triangle3 a = {corner(), corner(), corner()}, b = {corner(), corner(), corner()};
      SCOPED_TRACE(exponent);
      Stages unused, of_roundings;
      checkEverything(identity, identity, a, b, random, unused, of_roundings);
      const TriangleDistance distance(identity, identity);
      const Rational squared = test::squaredDistance(posed(identity, a[0]), posed(identity, b));
      const double length = distance.distance(a[0], b);
      expectNearest(length, squared);
      EXPECT_EQ(distance.compare(a[0], b, length), signOf(squared - Rational(length) * Rational(length)));
    }
  }
}

TEST(TriangleDistance, ComparesDistancesAsTheDefinitionDoes)
{
  Random random(304);
  Stages stages;
  int ties = 0;
  for (const TriangleShape shape :
       {TriangleShape::any, TriangleShape::lattice, TriangleShape::needle, TriangleShape::flat})
    for (int i = 0; i < 120; ++i) {
      const Isometry3d pose = poseOf(i % 5, random), other = poseOf(i % 3, random);
      const TriangleDistance first(pose, pose), second(other, other);
      const Triangle3 b = test::triangleOf(shape, 1.0, random);
      const Point3 p = test::cornerOf(shape, 1.0, random);
      Triangle3 c = test::triangleOf(shape, 1.0, random);
      Point3 q = test::cornerOf(shape, 1.0, random);
      if (random.chance(0.5)) c = {b[1], b[2], b[0]}, q = p; // the same, named otherwise
      const Rational x = test::squaredDistance(posed(pose, p), posed(pose, b));
      const Rational y = test::squaredDistance(posed(other, q), posed(other, c));
      ties += x == y;
      EXPECT_EQ(first.compareGaps({p, b}, second, {q, c}, &stages), signOf(x - y));
      const Triangle3 a = test::triangleOf(shape, 1.0, random);
      const Rational z = test::squaredDistance(posed(pose, a), posed(pose, b));
      const Rational w = test::squaredDistance(posed(other, a), posed(other, c));
      ties += z == w;
      EXPECT_EQ(first.compareGaps({a, b}, second, {a, c}, &stages), signOf(z - w));
    }
  report("comparisons of distances", stages);
  EXPECT_GT(ties, 100);
}

/// Cells of two walls that face each other.
std::vector<Triangle3> cellsAt(double height, double shift, const Isometry3d& placed)
{
  std::vector<Triangle3> cells;
  const auto at = [&](int i, int j) -> Point3 {
    const Eigen::Vector3d p = placed * Eigen::Vector3d(0.3 * i + shift, 0.3 * j + shift, height);
    return {p.x(), p.y(), p.z()};
  };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      cells.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      cells.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return cells;
}

/// All are equally far apart, except parts that are not opposite: posed by one turn, or turned and rounded.
TEST(TriangleDistance, ComparesWhatFacesEachOtherAsTheDefinitionDoes)
{
  const Isometry3d turn = Random(3).pose(1), none = Isometry3d::Identity();
  for (const bool rounded : {false, true})
    for (const double shift : {0.0, 0.01, 0.15}) {
      const Isometry3d pose = rounded ? none : turn, placed = rounded ? turn : none;
      const TriangleDistance distance(pose, pose);
      const std::vector<Triangle3> walls_a = cellsAt(0, 0, placed), walls_b = cellsAt(0.7, shift, placed);
      Stages stages;
      int asked = 0;
      for (std::size_t i = 0; i < walls_a.size(); i += 4)
        for (std::size_t j = 0; j < walls_b.size(); j += 2)
          for (std::size_t k = 0; k < walls_b.size(); k += 3) {
            TriangleDistance::Known of_first, of_second;
            const TriangleDistance::TrianglePair first{walls_a[i], walls_b[j], 0.0, &of_first};
            const TriangleDistance::TrianglePair second{walls_a[i], walls_b[k], 0.0, &of_second};
            const Rational x = test::squaredDistance(posed(pose, first.a), posed(pose, first.b));
            const Rational y = test::squaredDistance(posed(pose, second.a), posed(pose, second.b));
            const int expected = signOf(x - y);
            ASSERT_EQ(distance.compareGaps(first, distance, second, &stages), expected) << i << ' ' << j << ' ' << k;
            ASSERT_EQ(distance.compareGaps(second, distance, first), -expected); // what is kept is that of each
            ASSERT_EQ(distance.compareGaps({first.a, first.b}, distance, {second.a, second.b}), expected);
            ++asked;
          }
      report(std::string(rounded ? "rounded" : "posed") + " walls", stages);
      EXPECT_LT(stages.integers, static_cast<std::uint64_t>(asked) / 6) << rounded << ' ' << shift;
    }
}

/// A corner in common is a place in common under one pose alone.
TEST(TriangleDistance, KnowsThatWhatSharesACornerMeetsUnderOnePose)
{
  Random random(306);
  for (const TriangleShape shape : test::kTriangleShapes)
    for (int i = 0; i < 60; ++i) {
      const Isometry3d pose = poseOf(i % 5, random);
      Isometry3d other = pose;
      if (i % 2 == 1) other.translation()[random.integer(0, 2)] += random.pick({1e-9, 0.25, 3.0});
      const TriangleDistance distance(pose, other);
      const Triangle3 a = test::triangleOf(shape, 1.0, random);
      const auto sharing = [&](const Point3& corner) {
        Triangle3 t = test::triangleOf(shape, 1.0, random);
        t[static_cast<std::size_t>(random.integer(0, 2))] = corner;
        return t;
      };
      const Triangle3 b = sharing(a[0]), c = sharing(a[2]), alone = test::triangleOf(shape, 1.0, random);
      const auto squaredTo = [&](const auto& of_a, const Triangle3& of_b) {
        return test::squaredDistance(posed(pose, of_a), posed(other, of_b));
      };
      const Rational to_b = squaredTo(a, b), to_c = squaredTo(a, c), to_alone = squaredTo(a, alone),
                     from_corner = squaredTo(b[1], b);
      Stages stages;
      EXPECT_EQ(distance.compareGaps({a, b}, distance, {a, c}, &stages), signOf(to_b - to_c));
      EXPECT_EQ(distance.compare(a, b, 0.0, &stages), signOf(to_b));
      EXPECT_EQ(distance.compare(b[1], b, 0.0, 0.0, &stages), signOf(from_corner));
      if (i % 2 == 0) {
        EXPECT_EQ(stages.integers + stages.long_numbers, 0u);
      }
      EXPECT_EQ(distance.compareGaps({a, b}, distance, {a, alone}), signOf(to_b - to_alone));
      EXPECT_EQ(distance.compareGaps({a, alone}, distance, {a, b}), signOf(to_alone - to_b));
      expectNearest(distance.distance(a, b), to_b);
      expectNearest(distance.distance(b[1], b), from_corner);
      EXPECT_EQ(distance.compare(a, b, 1e-12), signOf(to_b - Rational(1e-12) * Rational(1e-12)));
    }
}

/// Sign of the root of x less the root of y less d.
int signOfRoots(const Rational& x, const Rational& y, const Rational& d)
{
  if (d < 0) return -signOfRoots(y, x, -d);
  // x against (d + sqrt(y))^2 = d^2 + y + 2 d sqrt(y)
  const Rational left = x - d * d - y, squared = 4 * d * d * y;
  return left <= 0 ? (left == 0 && squared == 0 ? 0 : -1) : signOf(left * left - squared);
}

TEST(TriangleDistance, TakesBallsAndSumsAsTheDefinitionDoes)
{
  Random random(305);
  int ties = 0, below = 0;
  for (const TriangleShape shape : test::kTriangleShapes)
    for (int i = 0; i < 60; ++i) {
      const Isometry3d pose = poseOf(i % 3, random), other = poseOf(i % 2, random);
      const TriangleDistance first(pose, pose), second(other, other);
      const double sizes[] = {0.0, std::ldexp(random.integer(0, 8), -10), random.uniform(0, 2)};
      const TriangleDistance::PointPair x{test::cornerOf(shape, 1.0, random), test::triangleOf(shape, 1.0, random),
                                          random.pick(sizes)};
      TriangleDistance::PointPair y{test::cornerOf(shape, 1.0, random), test::triangleOf(shape, 1.0, random),
                                    random.pick(sizes)};
      if (i % 4 == 0) y.a = x.a, y.b = {x.b[1], x.b[2], x.b[0]};
      if (i % 8 == 0) y.radius = x.radius;
      const Rational of_x = test::squaredDistance(posed(pose, x.a), posed(pose, x.b));
      const Rational of_y = test::squaredDistance(posed(other, y.a), posed(other, y.b));
      const int sign = signOfRoots(of_x, of_y, Rational(x.radius) - Rational(y.radius));
      ties += sign == 0;
      EXPECT_EQ(first.compareGaps(x, second, y), sign);
      EXPECT_EQ(second.compareGaps(y, first, x), -sign);

      const double gap = first.gap(x);
      below += gap < 0.0;
      const auto sideOf = [&](const Rational& length) { return signOfRoots(of_x, 0, Rational(x.radius) + length); };
      if (gap == 0.0) {
        EXPECT_EQ(sideOf(0), 0);
      }
      EXPECT_LE(sideOf((Rational(gap) + Rational(std::nextafter(gap, infinity))) / 2), 0);
      EXPECT_GE(sideOf((Rational(gap) + Rational(std::nextafter(gap, -infinity))) / 2), 0);
      for (const double sum : {gap, std::nextafter(gap, 9.0), std::nextafter(gap, -9.0), random.uniform(-1, 1)}) {
        const double part = random.uniform(-1, 1), tiny = std::ldexp(random.integer(-1, 1), -80);
        const ExactDistance::Sum reach = {sum, part, tiny, 0.0, -part};
        EXPECT_EQ(first.compare(x, reach), sideOf(Rational(sum) + Rational(tiny)));
        const ExactDistance::Sum with_radius = {sum, x.radius, tiny};
        EXPECT_EQ(first.compare(TriangleDistance::PointPair{x.a, x.b}, with_radius),
                  sideOf(Rational(sum) + Rational(tiny)));
      }
    }
  EXPECT_GT(ties, 10);
  EXPECT_GT(below, 50);
}

TEST(TriangleDistance, RoundsGapsOfBallsBesideDistancesBeyondAllDoubles)
{
  constexpr double far = 0x1.8p1023;
  const TriangleDistance distance(identity, identity);
  const Triangle3 wall = {{{far, 0, 0}, {far, 1, 0}, {far, 0, 1}}};
  const auto gap = [&](double x, double radius) {
    return distance.gap(TriangleDistance::PointPair{{x, 0, 0}, wall, radius});
  };
  EXPECT_EQ(gap(-far, 1.0), infinity);
  EXPECT_EQ(gap(-far, far), far);
  EXPECT_EQ(gap(-far, 0x1p1023), infinity); // 2^1024
  EXPECT_EQ(gap(-far, std::nextafter(0x1p1023, infinity)), std::numeric_limits<double>::max());
  EXPECT_EQ(gap(far, far), -far);
  const double beside = std::nextafter(far, 0.0);
  EXPECT_EQ(gap(beside, far), -beside);
}

/// The questions of a mesh and a scan near it: clearances that are unrelated to the distances.
TEST(TriangleDistance, DoublesDecideOrdinaryPairs)
{
  Random random(305);
  for (const bool far_away : {false, true}) {
    Isometry3d pose = random.pose(1.0);
    if (far_away) pose.pretranslate(Eigen::Vector3d(513449.7, 5402650.2, 300.1));
    const TriangleDistance distance(pose, pose);
    Stages points, triangles, lengths;
    for (int i = 0; i < 4000; ++i) {
      const TriangleShape shape = i % 2 == 0 ? TriangleShape::any : TriangleShape::needle;
      const Triangle3 b = test::triangleOf(shape, 0.1, random), a = test::triangleOf(shape, 0.1, random);
      distance.compare(nearTo(b, 0.02, random), b, 0.01, 0.0, &points);
      distance.compare(a, b, 0.01, &triangles);
      distance.distance(nearTo(b, 0.02, random), b, &lengths);
    }
    const std::string where = far_away ? ", far from the origin" : "";
    report("ordinary points" + where, points);
    report("ordinary triangles" + where, triangles);
    report("ordinary distances" + where, lengths);
    EXPECT_EQ(points.doubles, 4000u);
    EXPECT_EQ(triangles.doubles, 4000u);
    EXPECT_EQ(lengths.integers, 0u);
  }
}

} // namespace
} // namespace pcl_bsh
