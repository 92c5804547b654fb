// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/ball_about_box.h>

#include "support/random.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

using Rational = boost::multiprecision::cpp_rational;

TEST(BallAboutBox, HoldsItsCornersInRationalNumbers)
{
  test::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const double far = i % 2 == 0 ? 0.0 : 5412345.25, size = i % 3 == 0 ? 0.0 : std::pow(10.0, random.uniform(-6, 3));
    Point3 low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = far + random.uniform(-1, 1);
      high[k] = low[k] + size * random.uniform(0, 1);
    }
    const BoxBall ball = ballAboutBox(low, high);
    Rational square = 0, shortest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Rational down = Rational(ball.center[k]) - Rational(low[k]),
                     up = Rational(high[k]) - Rational(ball.center[k]), half = std::max(down, up);
      square += half * half;
      shortest += (Rational(high[k]) - Rational(low[k])) * (Rational(high[k]) - Rational(low[k])) / 4;
    }
    const Rational radius = ball.radius;
    EXPECT_GE(radius * radius, square) << i;
    EXPECT_LE(ball.radius, std::sqrt(static_cast<double>(shortest)) * (1 + 1e-9) + 0x1p-51 * far) << i; // and no more
  }
}

} // namespace
} // namespace pcl_bsh
