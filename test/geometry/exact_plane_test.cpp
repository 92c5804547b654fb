// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/exact/exact_plane.h>

#include "geometry/triangle_oracle.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

using test::Random;
using test::Rational;

TEST(ExactPlane, SidesAreThoseOfRationalNumbers)
{
  Random random(5);
  int in_plane = 0;
  for (int i = 0; i < 30000; ++i) {
    const int scale = random.pick({0, 0, -1072, -1000, 1021, -300});
    const auto number = [&] {
      const double x = random.chance(0.5) ? random.integer(-3, 3) : random.uniform(-1, 1);
      return std::ldexp(x, scale + (random.chance(0.05) ? random.integer(-60, 0) : 0));
    };
    const Point3 at = random.point(number), u = random.point(number);
    Point3 normal = random.point([&] { return std::ldexp(number(), -scale); });
    if (random.chance(0.2)) { // out of range beside the others
      normal[2] = std::ldexp(normal[2], -600);
      for (const std::size_t k : {0u, 1u}) normal[k] = std::ldexp(normal[k], random.pick({0, 500}));
    }
    Point3 place = random.point(number);
    if (random.chance(0.5)) { // in the plane, or by a rounding beside it
      place = {at[0] - u[2] * normal[1], at[1] + u[2] * normal[0], at[2]};
      if (random.chance(0.3)) place[0] = std::nextafter(place[0], 1e300);
      if (random.chance(0.3)) place[2] = number();
    }
    if (normal == Point3{0, 0, 0} || !isFinite(place)) continue;
    Rational height = 0;
    for (std::size_t k = 0; k < 3; ++k) height += Rational(normal[k]) * (Rational(place[k]) - Rational(at[k]));
    const ExactPlane plane(at, {Dyadic(normal[0]), Dyadic(normal[1]), Dyadic(normal[2])});
    ASSERT_EQ(plane.side(place), height.sign());
    in_plane += height == 0;
  }
  EXPECT_GT(in_plane, 300);
}

TEST(ExactPlane, HeightsAreEnclosed)
{
  Random random(6);
  int told = 0, not_told = 0, exact = 0;
  for (int i = 0; i < 30000; ++i) {
    const int scale = random.pick({0, 0, -1072, -900, 1021, -300});
    const auto number = [&] { return std::ldexp(random.uniform(-1, 1), scale); };
    const Point3 at = random.point(number);
    Point3 normal = random.point([&] { return random.uniform(-1, 1); });
    const Point3 more = random.point([&] { return random.pick({0.0, 0x1p-70, 0x1p-200}) * random.uniform(-1, 1); });
    if (random.chance(0.2)) normal[2] = std::ldexp(normal[2], random.pick({-600, -900, 900}));
    Point3 place = random.point(number);
    if (random.chance(0.3)) { // in the plane, within rounding
      const double far = number();
      place = {at[0] + far * normal[1], at[1] - far * normal[0], at[2]};
    }
    if (!isFinite(place)) continue;
    const ExactPlane plane(at, {Dyadic(normal[0]) + Dyadic(more[0]), Dyadic(normal[1]) + Dyadic(more[1]),
                                Dyadic(normal[2]) + Dyadic(more[2])});
    Rational height = 0;
    for (std::size_t k = 0; k < 3; ++k)
      height += (Rational(normal[k]) + Rational(more[k])) * (Rational(place[k]) - Rational(at[k]));
    for (int k = std::abs(plane.exponent()); k > 0; k -= std::min(k, 512))
      height *= Rational(std::ldexp(1.0, (plane.exponent() < 0 ? 1 : -1) * std::min(k, 512)));
    const double most = plane.heightAtMost(place);
    ++(std::isfinite(most) ? told : not_told);
    ASSERT_TRUE(!std::isfinite(most) || height <= Rational(most)) << i;
    const LongNumber longer = plane.height(place);
    if (!std::isfinite(longer.value()) || !std::isfinite(longer.error())) continue;
    const Rational off = height - Rational(longer.value()) - Rational(longer.tail());
    ASSERT_LE(abs(off), Rational(longer.error())) << i;
    exact += longer.error() < 0x1p-90 * std::abs(longer.value());
  }
  EXPECT_GT(told, 10000);
  EXPECT_GT(not_told, 1000);
  EXPECT_GT(exact, 5000);
}

} // namespace
} // namespace pcl_bsh
