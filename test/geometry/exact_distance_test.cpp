// SPDX-License-Identifier: BSD-3-Clause
// Against the definition, written out in fixed point and in 4,096-bit floats. Cases named H<n> are pairs of points at
// which other tools are known to answer wrongly.
#include <pcl_bsh/geometry/exact_distance.h>

#include "support/random.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <vector>

namespace pcl_bsh {

void PrintTo(const ExactDistance::Pair& pair, std::ostream* out)
{
  *out << std::hexfloat << "p";
  for (const double x : pair.p) *out << " " << x;
  *out << ", q";
  for (const double x : pair.q) *out << " " << x;
  *out << ", radii " << pair.radius_p << " " << pair.radius_q;
}

namespace {

using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<4096, boost::multiprecision::digit_base_2, void, std::int64_t>,
    boost::multiprecision::et_off>;
using Eigen::Isometry3d;
using Pair = ExactDistance::Pair;
using test::Random;

const Isometry3d identity = Isometry3d::Identity();
constexpr double infinity = std::numeric_limits<double>::infinity();

// The definition --------------------------------------------------------------------------------------------------

/// Every finite double is a multiple of 2^-1074; products come in multiples of 2^-2148.
Integer fixedPoint(double x)
{
  int exponent;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  const int shift = exponent - 53 + 1074;
  return shift >= 0 ? Integer(mantissa) << shift : Integer(mantissa >> -shift);
}

Wide wide(double x)
{
  return Wide(x);
}

template <class Number>
Number squaredDistance(const Isometry3d& pose_a, const Point3& p, const Isometry3d& pose_b, const Point3& q,
                       Number (*number)(double))
{
  Number squared = 0;
  for (int i = 0; i < 3; ++i) {
    Number difference = number(1.0) * number(pose_a(i, 3)) - number(1.0) * number(pose_b(i, 3));
    for (int j = 0; j < 3; ++j) {
      difference += number(pose_a(i, j)) * number(p[static_cast<std::size_t>(j)]);
      difference -= number(pose_b(i, j)) * number(q[static_cast<std::size_t>(j)]);
    }
    squared += difference * difference;
  }
  return squared;
}

int expectedCompare(const Isometry3d& pose_a, const Isometry3d& pose_b, const Pair& pair, double clearance)
{
  const Integer lengths = fixedPoint(clearance) + fixedPoint(pair.radius_p) + fixedPoint(pair.radius_q);
  const Integer reach = fixedPoint(1.0) * lengths;
  const int order = squaredDistance(pose_a, pair.p, pose_b, pair.q, fixedPoint).compare(reach * reach);
  return order < 0 ? -1 : order > 0;
}

Wide wideGap(const Isometry3d& pose_a, const Isometry3d& pose_b, const Pair& pair)
{
  return sqrt(squaredDistance(pose_a, pair.p, pose_b, pair.q, wide)) - Wide(pair.radius_p) - Wide(pair.radius_q);
}

/// Gaps of pairs of moderate size that differ, differ in the first 2,000 bits.
int expectedCompareGaps(const Isometry3d& pose_a, const Isometry3d& pose_b, const Pair& first, const Pair& second)
{
  const Wide x = wideGap(pose_a, pose_b, first);
  const Wide y = wideGap(pose_a, pose_b, second);
  const Wide scale = abs(x) + abs(y) + Wide(first.radius_p) + Wide(second.radius_p);
  return abs(x - y) <= ldexp(scale, -2000) ? 0 : (x < y ? -1 : 1);
}

/// No double is nearer to the exact value, and of two as near, this one is even.
void expectCorrectlyRounded(double rounded, const Wide& exact)
{
  const Wide error = abs(Wide(rounded) - exact);
  for (const double direction : {-infinity, infinity}) {
    const double neighbour = std::nextafter(rounded, direction);
    const Wide beyond = std::isfinite(neighbour) ? Wide(neighbour) : ldexp(Wide(neighbour > 0 ? 1 : -1), 1024);
    const Wide other_error = abs(beyond - exact);
    EXPECT_TRUE(error < other_error || (error == other_error && (std::bit_cast<std::uint64_t>(rounded) & 1) == 0))
        << std::hexfloat << rounded << " where " << neighbour << " is nearer";
  }
}

// Random input ----------------------------------------------------------------------------------------------------

/// Not a power of two: numbers made by multiplying with it use all their bits.
double anySize(Random& random)
{
  const double mantissa = random.uniform(1, 2);
  return std::ldexp(mantissa, random.integer(-10, 20));
}

/// Any finite double: exponents as likely as each other, denormals and zeros among them.
double anyDouble(Random& random, int min_exponent, int max_exponent)
{
  if (random.chance(0.1)) return 0.0;
  const double mantissa = random.uniform(-2, 2);
  return std::ldexp(mantissa, random.integer(min_exponent, max_exponent));
}

/// Half of the time; else the identity.
Isometry3d maybePose(Random& random, double reach)
{
  return random.chance(0.5) ? random.pose(reach) : identity;
}

/// The nearest double to the distance and the doubles around it: where a decision is hardest.
std::vector<double> clearancesAround(double distance)
{
  std::vector<double> clearances{0.0, distance};
  double below = distance, above = distance;
  for (int i = 0; i < 2; ++i) {
    below = std::nextafter(below, 0.0);
    above = std::nextafter(above, infinity);
    clearances.push_back(below);
    if (std::isfinite(above)) clearances.push_back(above);
  }
  return clearances;
}

float f(double x)
{
  return static_cast<float>(x);
}

bool collide(const Point3& p, const Point3& q, double clearance)
{
  return ExactDistance(identity, identity).compare(p, q, clearance) <= 0;
}

/// Ordered pairs within the clearance, each point with itself included.
std::size_t pairsWithin(const std::vector<Point3>& a, const std::vector<Point3>& b, double clearance)
{
  const ExactDistance distance(identity, identity);
  std::size_t pairs = 0;
  for (const Point3& p : a) {
    for (const Point3& q : b) pairs += distance.compare(p, q, clearance) <= 0;
  }
  return pairs;
}

template <class Coordinate>
std::vector<Point3> gridOf(int side, Coordinate coordinate)
{
  std::vector<Point3> points;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      for (int k = 0; k < side; ++k) points.push_back({coordinate(i), coordinate(j), coordinate(k)});
    }
  }
  return points;
}

template <class Make>
std::vector<Point3> listOf(int count, Make make)
{
  std::vector<Point3> points;
  for (int i = 0; i < count; ++i) points.push_back(make(i));
  return points;
}

void checkEverything(const Isometry3d& pose_a, const Isometry3d& pose_b, const Pair& pair)
{
  SCOPED_TRACE(testing::PrintToString(pair));
  const ExactDistance distance(pose_a, pose_b);
  const double gap = distance.gap(pair);
  const Wide exact = wideGap(pose_a, pose_b, pair);
  if (std::isfinite(gap)) {
    expectCorrectlyRounded(gap, exact);
  }
  else {
    EXPECT_GE(exact, ldexp(Wide(2) - ldexp(Wide(1), -53), 1023));
  }
  const Pair points{pair.p, pair.q};
  for (const double clearance : clearancesAround(std::min(distance.gap(points), std::numeric_limits<double>::max()))) {
    EXPECT_EQ(distance.compare(pair.p, pair.q, clearance), expectedCompare(pose_a, pose_b, points, clearance));
  }
  for (const double clearance : clearancesAround(std::abs(gap))) {
    if (!std::isfinite(clearance)) continue;
    EXPECT_EQ(distance.compare(pair.p, pair.q, clearance, pair.radius_p, pair.radius_q),
              expectedCompare(pose_a, pose_b, pair, clearance));
  }
}

// Decisions -------------------------------------------------------------------------------------------------------

TEST(ExactDistance, TouchingCounts)
{
  EXPECT_TRUE(collide({0, 0, 0}, {3, 4, 0}, 5));          // H1
  EXPECT_TRUE(collide({1, 2, 3}, {1, 2, 3}, 0));          // H2
  EXPECT_FALSE(collide({0, 0, 0}, {f(.1), 0, 0}, .1));    // H3
  EXPECT_TRUE(collide({0, 0, 0}, {f(1e30), 0, 0}, 2e30)); // H9

  int hits = 0; // H4
  for (int k = 1; k <= 10000; ++k) hits += collide({0, 0, 0}, {f(k / 1000.0), 0, 0}, k / 1000.0);
  EXPECT_EQ(hits, 5033);
}

TEST(ExactDistance, DenormalAndTinyLengths)
{
  EXPECT_TRUE(collide({0, 0, 0}, {f(3e-40), f(4e-40), 0}, 5.1e-40)); // H8
  EXPECT_FALSE(collide({0, 0, 0}, {f(1e-40), 0, 0}, 5e-41));         // H8b
  EXPECT_FALSE(collide({0, 0, 0}, {f(1e-23), 0, 0}, 5e-24));         // H8c
  constexpr double denormal = std::numeric_limits<double>::denorm_min();
  EXPECT_TRUE(collide({0, 0, 0}, {3 * denormal, 4 * denormal, 0}, 5 * denormal));
  EXPECT_FALSE(collide({0, 0, 0}, {3 * denormal, 4 * denormal, denormal}, 5 * denormal));
  EXPECT_EQ(ExactDistance(identity, identity).compare({1, 1, 1}, {1, 1, 1}, 1e-200), -1);
}

TEST(ExactDistance, CountsOfPairsOnGrids)
{
  const auto sixteenths = gridOf(12, [](int i) { return i / 16.0; });
  EXPECT_EQ(pairsWithin(sixteenths, sixteenths, 3.0 / 16.0), 157240u); // H5
  const auto hundredths = gridOf(12, [](int i) { return f(.01 * i); });
  EXPECT_EQ(pairsWithin(hundredths, hundredths, .03), 141232u); // H5b
  const auto far = gridOf(12, [](int i) { return f(1000 + .01 * i); });
  EXPECT_EQ(pairsWithin(far, far, .03), 144280u); // H5c
}

TEST(ExactDistance, CountsOfPairsOnLines)
{
  const auto row = [](double y) { return listOf(1000, [y](int i) { return Point3{500000.003 + .01 * i, y, 100}; }); };
  EXPECT_EQ(pairsWithin(row(5400000.26), row(5400000.34), .05), 0u);    // H6
  EXPECT_EQ(pairsWithin(row(5400000.24), row(5400000.26), .05), 8980u); // H6b
  const auto microns = listOf(1000, [](int i) { return Point3{1000 + 1e-7 * i, 0, 0}; });
  EXPECT_EQ(pairsWithin(microns, microns, 1e-6), 20846u); // H10
  const auto steps = listOf(64, [](int i) { return Point3{1000 + i * 0x1p-14, 0, 0}; });
  EXPECT_EQ(pairsWithin(steps, steps, 0x1p-14), 190u); // H11
}

TEST(ExactDistance, EqualsTheDefinitionNearTies) // H21, and the same without rotation
{
  Random random(21);
  for (int i = 0; i < 2000; ++i) {
    const double size = anySize(random);
    const bool narrow = random.chance(0.5);
    const auto coordinate = [&] {
      const double x = size * random.uniform(-1, 1);
      return narrow ? f(x) : x;
    };
    const auto radius = [&] { return random.chance(0.5) ? f(size * random.uniform(0, 1)) : 0.0f; };
    const Isometry3d pose_a = maybePose(random, size);
    const Isometry3d pose_b = maybePose(random, size);
    checkEverything(pose_a, pose_b, {random.point(coordinate), random.point(coordinate), radius(), radius()});
  }
}

TEST(ExactDistance, EqualsTheDefinitionFarFromTheOrigin)
{
  Random random(5400000);
  for (int i = 0; i < 1000; ++i) {
    const double size = anySize(random);
    const Isometry3d pose_a = random.pose(1e6 * size);
    Isometry3d pose_b = maybePose(random, 1e6 * size);
    const auto coordinate = [&] { return 1e6 * size * random.uniform(-1, 1); };
    const Point3 p = random.point(coordinate);
    const Eigen::Vector3d near = pose_b.inverse() * (pose_a * Eigen::Vector3d(p[0], p[1], p[2]));
    const auto nudged = [&](double x) { return x + size * random.uniform(-1, 1); };
    checkEverything(pose_a, pose_b, {p, {nudged(near[0]), nudged(near[1]), nudged(near[2])}, size / 8, size / 4});
  }
}

TEST(ExactDistance, TakesAnyTwelveNumbers)
{
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    Isometry3d pose_a = identity, pose_b = identity;
    for (Isometry3d* pose : {&pose_a, &pose_b}) {
      for (int k = 0; k < 12; ++k) (*pose)(k / 4, k % 4) = random.uniform(-3, 3);
    }
    const auto coordinate = [&] { return random.uniform(-10, 10); };
    checkEverything(pose_a, pose_b, {random.point(coordinate), random.point(coordinate), 0.5, 0.25});
  }
}

TEST(ExactDistance, EqualsTheDefinitionOnPythagoreanTies)
{
  Random random(345);
  Isometry3d quarter_turn = identity;
  quarter_turn.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Isometry3d shift = identity;
  shift.pretranslate(Eigen::Vector3d(0.125, -64.5, 1000.0));
  const int legs[][4] = {{3, 4, 0, 5}, {1, 2, 2, 3}, {2, 3, 6, 7}, {4, 4, 7, 9}, {0, 5, 12, 13}, {2, 10, 11, 15}};
  for (int i = 0; i < 2000; ++i) {
    const int* leg = legs[random.integer(0, 5)];
    const double unit =
        std::ldexp(random.integer(1, 100), i % 2 == 0 ? random.integer(-60, 60) : random.integer(-1060, 1000));
    const Point3 p = random.point([&] { return unit * random.integer(-1000, 1000); });
    const Point3 q = {p[0] + unit * leg[0], p[1] - unit * leg[1], p[2] + unit * leg[2]};
    for (const Isometry3d& pose : {identity, quarter_turn, shift}) {
      const ExactDistance distance(pose, pose);
      EXPECT_EQ(distance.compare(p, q, unit * leg[3]), 0);
      EXPECT_EQ(distance.compare(p, q, unit * (leg[3] - 1), unit * 0.25, unit * 0.75), 0);
      EXPECT_EQ(distance.compare(p, q, std::nextafter(unit * leg[3], 0.0)), 1);
      EXPECT_EQ(distance.compare(p, q, std::nextafter(unit * leg[3], infinity)), -1);
      EXPECT_EQ(distance.gap({p, q}), unit * leg[3]);
      EXPECT_EQ(distance.gap({p, q, unit * leg[3], unit}), -unit);
    }
  }
}

TEST(ExactDistance, EqualsTheDefinitionAtAnyMagnitude)
{
  struct Range {
    int min_exponent, max_exponent;
  };
  Random random(1074);
  for (const Range range :
       {Range{-1080, -1000}, Range{-600, -400}, Range{400, 600}, Range{1000, 1023}, Range{-1080, 1023}}) {
    for (int i = 0; i < 60; ++i) {
      const auto coordinate = [&] { return anyDouble(random, range.min_exponent, range.max_exponent); };
      const auto radius = [&] { return std::abs(coordinate()) / 4; };
      Isometry3d shift = identity;
      shift.pretranslate(Eigen::Vector3d(coordinate(), coordinate(), coordinate()));
      const Isometry3d pose_b = i % 3 == 0 ? identity : i % 3 == 1 ? shift : random.pose(1);
      const Pair pair{random.point(coordinate), random.point(coordinate), radius(), radius()};
      SCOPED_TRACE(testing::PrintToString(pair));
      const ExactDistance distance(identity, pose_b);
      const Pair points{pair.p, pair.q};
      const double length = std::min(distance.gap(points), std::numeric_limits<double>::max());
      for (double clearance : clearancesAround(length)) {
        EXPECT_EQ(distance.compare(pair.p, pair.q, clearance), expectedCompare(identity, pose_b, points, clearance));
        clearance = std::max(0.0, clearance - pair.radius_p - pair.radius_q);
        EXPECT_EQ(distance.compare(pair.p, pair.q, clearance, pair.radius_p, pair.radius_q),
                  expectedCompare(identity, pose_b, pair, clearance));
      }
    }
  }
}

// Gaps ------------------------------------------------------------------------------------------------------------

TEST(ExactDistance, GapOfOverlappingBallsIsNegative)
{
  const ExactDistance distance(identity, identity);
  EXPECT_EQ(distance.gap({{0, 0, 0}, {3, 4, 0}, 4, 2}), -1.0);
  EXPECT_EQ(distance.gap({{0, 0, 0}, {3, 4, 0}, 4, 1}), 0.0);
  EXPECT_FALSE(std::signbit(distance.gap({{0, 0, 0}, {3, 4, 0}, 4, 1})));
  EXPECT_EQ(distance.gap({{1, 1, 1}, {1, 1, 1}, 0.5, 0.25}), -0.75);
}

TEST(ExactDistance, GapSurvivesCancellation)
{
  const ExactDistance distance(identity, identity);
  // |(1, 2^-40, 0)| - 1 = 2^-81 - 2^-163 + ...
  EXPECT_EQ(distance.gap({{0, 0, 0}, {1, 0x1p-40, 0}, 1, 0}), 0x1p-81);
  EXPECT_EQ(distance.gap({{0, 0, 0}, {1, 0x1p-200, 0}, 1, 0}), 0x1p-401);
}

TEST(ExactDistance, GapRoundsTiesToEvenAndOverflowsToInfinity)
{
  const ExactDistance distance(identity, identity);
  EXPECT_EQ(distance.gap({{0x1p53, 0, 0}, {-1, 0, 0}}), 0x1p53);
  EXPECT_EQ(distance.gap({{0x1p53 + 2, 0, 0}, {-1, 0, 0}}), 0x1p53 + 4);
  constexpr double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(distance.gap({{largest, 0, 0}, {0, 0, 0}}), largest);
  EXPECT_EQ(distance.gap({{largest, 0, 0}, {-1e280, 0, 0}}), largest);
  EXPECT_EQ(distance.gap({{largest, 0, 0}, {-largest, 0, 0}}), infinity);
  EXPECT_EQ(distance.gap({{0, 0, 0}, {0, 0, 0}, largest, largest}), -infinity);
}

TEST(ExactDistance, ComparesGapsAsTheDefinitionDoes)
{
  Random random(7);
  for (int i = 0; i < 1500; ++i) {
    const double size = anySize(random);
    const auto coordinate = [&] { return static_cast<double>(f(size * random.uniform(-1, 1))); };
    const auto radius = [&] { return random.chance(0.5) ? f(size * random.uniform(0, 1)) : 0.0f; };
    const Isometry3d pose_a = maybePose(random, size);
    const Isometry3d pose_b = maybePose(random, size);
    const ExactDistance distance(pose_a, pose_b);
    const Pair first{random.point(coordinate), random.point(coordinate), radius(), radius()};
    Pair second{random.point(coordinate), random.point(coordinate), radius(), radius()};
    if (i % 3 == 0) second = {first.p, first.q, first.radius_q, first.radius_p};
    if (i % 3 == 1) { // another distance, but a radius that makes up for it as well as a double can
      const double excess = distance.gap({second.p, second.q, second.radius_p}) - distance.gap(first);
      if (excess < 0) continue;
      second.radius_q = excess;
    }
    SCOPED_TRACE(testing::PrintToString(first) + " / " + testing::PrintToString(second));
    const int expected = expectedCompareGaps(pose_a, pose_b, first, second);
    EXPECT_EQ(distance.compareGaps(first, second), expected);
    EXPECT_EQ(distance.compareGaps(second, first), -expected);
    EXPECT_EQ(distance.compareGaps(first, first), 0);
  }
}

TEST(ExactDistance, ComparesGapsThatDifferInOneNumberByABit)
{
  const ExactDistance distance(identity, identity);
  const Pair first{{0, 0, 0}, {3, 4, 5}, 0.5, 0.25};
  EXPECT_EQ(distance.compareGaps(first, first), 0);
  Pair nearer = first, farther = first, of_greater_radius = first, other_radius = first;
  nearer.p[0] = 0x1p-51;
  farther.q[2] = std::nextafter(5.0, 9.0);
  of_greater_radius.radius_p = std::nextafter(0.5, 1.0);
  other_radius.radius_q = std::nextafter(0.25, 1.0);
  for (const Pair& less : {nearer, of_greater_radius, other_radius}) {
    EXPECT_EQ(distance.compareGaps(less, first), -1) << testing::PrintToString(less);
    EXPECT_EQ(distance.compareGaps(first, less), 1) << testing::PrintToString(less);
  }
  EXPECT_EQ(distance.compareGaps(farther, first), 1);
  EXPECT_EQ(distance.compareGaps(first, farther), -1);
}

TEST(ExactDistance, ComparesEqualGapsOfDifferentMaking)
{
  const ExactDistance distance(identity, identity);
  const Pair five{{0, 0, 0}, {3, 4, 0}}, seven_less_two{{9, 9, 9}, {11, 12, 15}, 1, 1};
  EXPECT_EQ(distance.compareGaps(five, seven_less_two), 0);
  EXPECT_EQ(distance.compareGaps(seven_less_two, five), 0);
  // sqrt(2) with a shift of 0 and with radii that cancel: irrational, yet equal.
  const Pair root{{0, 0, 0}, {1, 1, 0}, 0.5, 0.25}, same{{5, 0, 1}, {5, 1, 2}, 0.25, 0.5};
  EXPECT_EQ(distance.compareGaps(root, same), 0);
  const Pair more{{5, 0, 1}, {5, 1, 2}, 0.25, std::nextafter(0.5, 1.0)};
  EXPECT_EQ(distance.compareGaps(root, more), 1);
  EXPECT_EQ(distance.compareGaps(more, root), -1);
  // sqrt(8) - sqrt(2) = sqrt(2): what shift and root may look like when both sides are irrational.
  const Pair large{{0, 0, 0}, {2, 2, 0}, std::sqrt(2.0)};
  const Pair small{{0, 0, 0}, {1, 1, 0}};
  EXPECT_EQ(distance.compareGaps(large, small), expectedCompareGaps(identity, identity, large, small));
}

} // namespace
} // namespace pcl_bsh
