// SPDX-License-Identifier: BSD-3-Clause
// Attacks on the bounds of distances, on every instruction set: a search climbs towards the worst rounding. Lengths are
// judged by binary numbers of 1200 bits, which hold the squares of these numbers exactly.
#include <pcl_bsh/distances/bound_margin.h>
#include <pcl_bsh/geometry/exact/rounded_length.h>

#include "kernels.h"
#include "support/attack.h"
#include "support/climb.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace pcl_bsh {
namespace {

using test::Random;
using Numbers = std::vector<double>;
using Real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<1200, boost::multiprecision::digit_base_2>,
                                  boost::multiprecision::et_off>;

/// Two points, and a shift given as the difference of two numbers.
struct Pair {
  explicit Pair(const Numbers& n)
  {
    const auto number = [&](std::size_t k) {
      const double x = std::clamp(n[k], -0x1p60, 0x1p60);
      return std::abs(x) < 0x1p-200 ? 0.0 : x;
    };
    Real sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = number(k), q[k] = number(k + 3);
      shift[k] = twoSum(number(k + 6), -number(k + 9));
      const Real c = Real(p[k]) - Real(q[k]) + Real(shift[k].value) + Real(shift[k].error);
      sum += c * c;
    }
    exact = sqrt(sum);
    found = test::longLength(p, q, shift);
  }

  /// Whether the rounded length is the double nearest to the exact one, or NaN.
  bool isRight() const
  {
    if (std::isnan(found.rounded)) return true;
    const Real off = abs(exact - Real(found.rounded));
    return off <= abs(exact - Real(std::nextafter(found.rounded, 0.0))) &&
           off <= abs(exact - Real(std::nextafter(found.rounded, 0x1p100)));
  }

  /// Error of the long length, as a part of kLengthDoubt.
  double fraction() const
  {
    if (!found.known) return 0.0;
    const Real off = abs(exact - (Real(found.root) + Real(found.correction)));
    return static_cast<double>(off / (Real(found.root) * Real(kLengthDoubt)));
  }

  std::array<double, 3> p, q;
  std::array<WithError, 3> shift;
  Real exact;
  test::LongLength found;
};

TEST(DistancesAttack, LongLengths)
{
  std::size_t targets = 0;
  test::onEveryTarget([&](const std::string& target) {
    Random random(401);
    const auto start = [&] {
      Numbers n;
      for (int k = 0; k < 12; ++k) n.push_back(test::suspect(random, 20));
      if (random.chance(0.7)) // a tail as large as is known, next to a value
        for (std::size_t k = 0; k < 3; ++k) {
          n[k + 6] = std::ldexp(random.uniform(0.5, 1), random.integer(-1, 2));
          n[k + 9] = n[k + 6] - std::ldexp(random.uniform(0.5, 1), random.integer(-3, 1));
          n[k + 3] = std::ldexp(random.uniform(-1, 1), random.integer(-52, 0));
        }
      return n;
    };
    double most = 0.0;
    const auto fitness = [](const Numbers& n) {
      const Pair pair(n);
      EXPECT_TRUE(pair.isRight());
      return pair.fraction();
    };
    if (!Pair(Numbers{3, 4, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0}).found.known) return; // no such arithmetic
    ++targets;
    most = test::climbFromMany(start, fitness, 12, 150, random);
    test::report("long lengths, " + target, most);
    EXPECT_GE(most, 0.3);
  });
  EXPECT_GT(targets, 0u);
}

/// Lengths next to the middle of two doubles: where the doubt is larger than what tells them apart, there is no answer.
TEST(DistancesAttack, LengthsNextToTheMiddleOfTwoDoubles)
{
  std::size_t answers = 0, doubts = 0;
  test::onEveryTarget([&](const std::string&) {
    if (!Pair(Numbers{3, 4, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0}).found.known) return;
    Random random(402);
    for (int bits = 56; bits < 160; ++bits)
      for (int k = 0; k < 40; ++k) {
        const double length = 1.0 + std::ldexp(random.integer(0, 1 << 20), -52);
        const double middle = std::ldexp(random.chance(0.5) ? 1.0 : -1.0, -53);
        const double off = std::ldexp(random.chance(0.3) ? 0.0 : random.chance(0.5) ? 1.0 : -1.0, -bits);
        // length + middle + off along one axis, and across it as much as adds about a square of 2^-bits
        Numbers n(12, 0.0);
        const auto axis = static_cast<std::size_t>(random.integer(0, 2));
        n[axis] = length;
        n[axis + 3] = -middle;
        n[axis + 6] = off;
        if (random.chance(0.5)) n[(axis + 1) % 3] = std::ldexp(random.uniform(0, 1), -bits / 2);
        const Pair pair(n);
        ASSERT_TRUE(pair.isRight()) << bits << " bits, " << k;
        ++(std::isnan(pair.found.rounded) ? doubts : answers);
      }
  });
  EXPECT_GT(answers, 500u);
  EXPECT_GT(doubts, 500u);
}

/// A sphere, another one and a reach: by how much a bound without its margin would be wrong, as a part of the margin.
double boundFraction(const Numbers& n)
{
  float a[3], b[3];
  for (std::size_t k = 0; k < 3; ++k) a[k] = test::floatOf(n[k]), b[k] = test::floatOf(n[k + 3]);
  const auto length = [&](std::size_t k) { return std::abs(test::floatOf(n[k])); };
  const float radius = length(6), stretch = 1.0f + std::min(length(7), 0.5f), other = length(8);
  const float reach = std::max(length(9), static_cast<float>(kSmallestLength)),
              unit = 1.0f + std::min(length(10), 0.5f);
  const test::DistanceBounds found = test::boundDistance(a, radius * stretch, b, other * stretch, {reach, unit, unit});
  long double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const long double difference = static_cast<long double>(a[k]) - static_cast<long double>(b[k]);
    squared += difference * difference; // 2^-64 of it, beside margins of 2^-22
  }
  const long double between = std::sqrt(squared);
  const long double radii =
      (static_cast<long double>(radius) + static_cast<long double>(other)) * static_cast<long double>(stretch) +
      static_cast<long double>(reach);
  const long double margin =
      static_cast<long double>(kBoundMargin) * (between + radii) * static_cast<long double>(unit);
  if (!(margin > 0x1p-40L)) return 0.0; // what underflows is in the reach
  const long double lower = (between - radii) * static_cast<long double>(unit),
                    upper = (between + radii) * static_cast<long double>(unit);
  const long double below = (lower - static_cast<long double>(found.lower)) / margin,
                    above = (static_cast<long double>(found.upper) - upper) / margin;
  return static_cast<double>(1.0L - std::min(below, above)); // 0: rounding took nothing; 1: all of the margin
}

/// The fraction for a box and a sphere.
double boxFraction(const Numbers& n)
{
  float low[3], high[3], center[3];
  long double near_squared = 0, far_squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const float x = test::floatOf(n[k]), y = test::floatOf(n[k + 3]);
    low[k] = std::min(x, y), high[k] = std::max(x, y), center[k] = test::floatOf(n[k + 6]);
    const auto below = static_cast<long double>(low[k]) - static_cast<long double>(center[k]);
    const auto above = static_cast<long double>(center[k]) - static_cast<long double>(high[k]);
    const long double near = std::max({below, above, 0.0L}), far = std::max(-below, -above);
    near_squared += near * near;
    far_squared += far * far;
  }
  const float radius = std::abs(test::floatOf(n[9])), stretch = 1.0f + std::min(std::abs(test::floatOf(n[10])), 0.5f),
              reach = std::max(std::abs(test::floatOf(n[11])), static_cast<float>(kSmallestLength)),
              unit = 1.0f + std::min(std::abs(test::floatOf(n[12])), 0.5f);
  const test::DistanceBounds found = test::boundOfBox(low, high, center, radius, stretch, {reach, unit, unit});
  const long double scale = static_cast<long double>(unit);
  const long double radii =
      static_cast<long double>(radius) * static_cast<long double>(stretch) + static_cast<long double>(reach);
  const auto fraction = [&](long double between, long double spare) {
    const long double margin = static_cast<long double>(kBoundMargin) * (between + radii) * scale;
    return margin > 0x1p-40L ? static_cast<double>(1.0L - spare / margin) : 0.0;
  };
  const long double near = std::sqrt(near_squared), far = std::sqrt(far_squared);
  return std::max(fraction(near, (near - radii) * scale - static_cast<long double>(found.lower)),
                  fraction(far, static_cast<long double>(found.upper) - (far + radii) * scale));
}

TEST(DistancesAttack, BoundsOfBoxes)
{
  test::onEveryTarget([](const std::string& target) {
    Random random(404);
    const auto start = [&] {
      Numbers n;
      for (int k = 0; k < 9; ++k) n.push_back(test::suspect(random, 12));
      if (random.chance(0.5))
        for (std::size_t k = 0; k < 9; ++k)
          if (k % 3 != 0) n[k] *= 0x1p-13 * random.integer(0, 4);
      for (int k = 0; k < 4; ++k) n.push_back(std::ldexp(random.uniform(0, 1), -random.integer(0, 26)));
      return n;
    };
    const double reached = test::climbFromMany(start, boxFraction, 30, 600, random);
    test::report("bounds of boxes, " + target, reached);
    EXPECT_GE(reached, 0.5);
  });
}

TEST(DistancesAttack, BoundsOfSpheres)
{
  test::onEveryTarget([](const std::string& target) {
    Random random(403);
    const auto start = [&] {
      Numbers n;
      for (int k = 0; k < 6; ++k) n.push_back(test::suspect(random, 12));
      if (random.chance(0.5)) // along one axis, where a square has all of its roundings
        for (std::size_t k = 0; k < 6; ++k)
          if (k % 3 != 0) n[k] *= 0x1p-13 * random.integer(0, 4);
      for (int k = 0; k < 5; ++k) n.push_back(std::ldexp(random.uniform(0, 1), -random.integer(0, 26)));
      return n;
    };
    const double reached = test::climbFromMany(start, boundFraction, 30, 600, random);
    test::report("bounds of distances, " + target, reached);
    EXPECT_GE(reached, 0.6); // two and a half roundings less would be wrong; one less is refused by the proof
  });
}

} // namespace
} // namespace pcl_bsh
