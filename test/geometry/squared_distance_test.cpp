// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/squared_distance.h>

#include <pcl_bsh/geometry/exact/dyadic.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <limits>

namespace pcl_bsh {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Whether no float is nearer to |p - q|^2, judged in exact arithmetic.
bool isNearest(float value, const Point3& p, const Point3& q)
{
  Dyadic squared;
  for (std::size_t k = 0; k < 3; ++k) {
    const Dyadic difference = Dyadic(p[k]) - Dyadic(q[k]);
    squared += difference * difference;
  }
  const auto gap = [&](float x) {
    const Dyadic difference = squared - Dyadic(static_cast<double>(x));
    return difference.sign() < 0 ? -difference : difference;
  };
  const float above = std::nextafter(value, kInfinity), below = std::nextafter(value, 0.0f);
  return (gap(value) - gap(above)).sign() <= 0 && (gap(value) - gap(below)).sign() <= 0;
}

TEST(SquaredDistance, IsTheNearestFloat)
{
  test::Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::ldexp(1.0, random.integer(-40, 40));
    const Point3 p = random.point([&] { return scale * random.uniform(-1, 1); });
    const Point3 q = random.point([&] { return scale * random.uniform(-1, 1); });
    EXPECT_TRUE(isNearest(squaredDistanceAsFloat(p, q), p, q));
  }
}

TEST(SquaredDistance, HalfwayGoesToEven)
{
  // 2^24 + 1 lies halfway between floats; so does 2^24 + 3.
  EXPECT_EQ(squaredDistanceAsFloat({4096, 1, 0}, {0, 0, 0}), 0x1p24f);
  EXPECT_EQ(squaredDistanceAsFloat({4096, 1, 1}, {0, 0, 0}), 0x1p24f + 2);
  const double root = std::sqrt(2.0); // a little above that of 2
  EXPECT_EQ(squaredDistanceAsFloat({4096, 1, root}, {0, 0, 0}), 0x1p24f + 4);
  EXPECT_EQ(squaredDistanceAsFloat({4096, 1, std::nextafter(root, 0.0)}, {0, 0, 0}), 0x1p24f + 2) << "odd, but nearer";
}

TEST(SquaredDistance, IsSettledFromWhateverIsGuessed)
{
  test::Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Point3 p = random.point([&] { return random.uniform(-1, 1); });
    const Point3 q = random.point([&] { return random.uniform(-1, 1); });
    const float nearest = squaredDistanceAsFloat(p, q);
    float low = nearest, high = nearest;
    for (int steps = 0; steps < 4; ++steps) {
      EXPECT_EQ(settleSquaredDistance(p, q, low), nearest);
      EXPECT_EQ(settleSquaredDistance(p, q, high), nearest);
      low = std::nextafter(low, 0.0f);
      high = std::nextafter(high, kInfinity);
    }
  }
  constexpr float largest = std::numeric_limits<float>::max();
  const double root = std::sqrt(static_cast<double>(largest)); // half a step above it is infinite
  const double beyond = std::sqrt(static_cast<double>(largest) + 0x1p103);
  EXPECT_EQ(settleSquaredDistance({root, 0, 0}, {0, 0, 0}, 0.999999 * static_cast<double>(largest)), largest);
  EXPECT_EQ(settleSquaredDistance({root, 0, 0}, {0, 0, 0}, kInfinity), largest);
  EXPECT_EQ(settleSquaredDistance({beyond * (1 - 1e-15), 0, 0}, {0, 0, 0}, largest), largest);
  EXPECT_EQ(settleSquaredDistance({beyond * (1 + 1e-15), 0, 0}, {0, 0, 0}, largest), kInfinity);
}

TEST(SquaredDistance, TinyAndHuge)
{
  EXPECT_EQ(squaredDistanceAsFloat({1e-300, 0, 0}, {0, 0, 0}), 0.0f);
  EXPECT_EQ(squaredDistanceAsFloat({1e-22, 0, 0}, {0, 0, 0}), 1e-44f);
  EXPECT_EQ(squaredDistanceAsFloat({1e30, 0, 0}, {0, 0, 0}), kInfinity);
  EXPECT_EQ(squaredDistanceAsFloat({1e200, 0, 0}, {-1e200, 0, 0}), kInfinity);
  EXPECT_EQ(squaredDistanceAsFloat({5, 5, 5}, {5, 5, 5}), 0.0f);
}

} // namespace
} // namespace pcl_bsh
