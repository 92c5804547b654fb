// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/coordinate_spacing.h>
#include <pcl_bsh/geometry/rounding.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_bsh {
namespace {

struct Stored {
  float center[3];
  double error[3];
};

/// Straight-line code of two lanes: what g++ 12 vectorises without the rounding when the cast is a plain one.
[[gnu::noinline]] Stored store(const double (&p)[3])
{
  Stored s;
  for (int k = 0; k < 3; ++k) {
    s.center[k] = roundToFloat(p[k]);
    s.error[k] = p[k] - static_cast<double>(s.center[k]);
  }
  return s;
}

TEST(Rounding, SurvivesVectorisation) // H26
{
  const Stored s = store({0.1, 0.2, 0.3});
  EXPECT_NEAR(s.error[0], -1.49e-9, 1e-11);
  EXPECT_NEAR(s.error[1], -2.98e-9, 1e-11);
  EXPECT_NEAR(s.error[2], -1.192e-8, 1e-11);
}

TEST(Rounding, OutwardAndNoFarther)
{
  test::Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::ldexp(random.uniform(-1, 1), random.integer(-160, 127));
    const float up = roundUp(x), down = roundDown(x);
    EXPECT_GE(static_cast<double>(up), x);
    EXPECT_LE(static_cast<double>(down), x);
    EXPECT_TRUE(up == down || up == std::nextafter(down, INFINITY));
  }
  EXPECT_EQ(roundUp(1e39), INFINITY);
  EXPECT_EQ(roundDown(1e39), std::numeric_limits<float>::max());
  EXPECT_EQ(roundUp(1e-60), std::numeric_limits<float>::denorm_min());
  EXPECT_EQ(roundDown(1e-60), 0.0f);
  EXPECT_EQ(roundDown(-1e39), -INFINITY);
  EXPECT_EQ(roundUp(-1e39), -std::numeric_limits<float>::max());
  EXPECT_EQ(roundDown(-1e-60), -std::numeric_limits<float>::denorm_min());
  EXPECT_EQ(roundUp(-1e-60), 0.0f);
  for (const double same : {0.0, -0.0, 1.0, -0x1p-149, double{INFINITY}, -double{INFINITY}}) {
    EXPECT_EQ(roundUp(same), same);
    EXPECT_EQ(roundDown(same), same);
  }
  EXPECT_TRUE(std::isnan(roundUp(NAN)) && std::isnan(roundDown(NAN)));
}

/// For a number between two, as sums of doubles are, it is the spacing at the smaller one.
TEST(Rounding, SpacingOfFloat32Numbers)
{
  EXPECT_EQ(float32Spacing(1000.0), 0x1p-14);
  EXPECT_EQ(float32Spacing(1024.0), 0x1p-14);
  EXPECT_EQ(float32Spacing(std::nextafter(1024.0, 2000.0)), 0x1p-14);
  EXPECT_EQ(float32Spacing(1025.0), 0x1p-13);
  EXPECT_EQ(float32Spacing(1e300), 0x1p104);
  EXPECT_EQ(float32Spacing(0.0), 0.0);
}

TEST(Rounding, SumsAndProductsWithTheirErrors)
{
  const WithError sum = twoSum(1.0, 0x1p-60), product = twoProduct(1 + 0x1p-30, 1 + 0x1p-30);
  EXPECT_EQ(sum.value, 1.0);
  EXPECT_EQ(sum.error, 0x1p-60);
  EXPECT_EQ(product.value, 1 + 0x1p-29);
  EXPECT_EQ(product.error, 0x1p-60);
}

} // namespace
} // namespace pcl_bsh
