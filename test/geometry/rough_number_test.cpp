// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/exact/rough_number.h>

#include "support/random.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

using Rational = boost::multiprecision::cpp_rational;

/// A few operations on the same numbers, rough and exact.
template <class Number>
Number combined(const double (&x)[6], unsigned operations)
{
  Number value(x[0]);
  for (std::size_t k = 1; k < 6; ++k, operations /= 4) {
    const Number next(x[k]);
    const unsigned operation = operations % 4;
    value = operation == 0   ? Number(value + next)
            : operation == 1 ? Number(value - next)
            : operation == 2 ? Number(value * next)
                             : Number(-value);
  }
  return value;
}

TEST(RoughNumber, IsNoFartherFromTheExactOneThanItsError)
{
  test::Random random(4);
  double worst = 0.0;
  for (int i = 0; i < 100000; ++i) {
    double x[6];
    for (double& number : x) number = std::ldexp(random.uniform(-1, 1), random.integer(-30, 30));
    const auto operations = static_cast<unsigned>(random.integer(0, 1023));
    const RoughNumber rough = combined<RoughNumber>(x, operations);
    const Rational exact = combined<Rational>(x, operations), off = abs(exact - Rational(rough.value()));
    ASSERT_LE(off, Rational(rough.error())) << i;
    bool sure = true;
    const int sign = rough.sign(sure);
    if (sure) {
      ASSERT_EQ(sign, exact.sign()) << i;
    }
    if (rough.error() > 0.0) worst = std::max(worst, Rational(off / Rational(rough.error())).convert_to<double>());
  }
  EXPECT_GT(worst, 0.9) << "of the error: it is no larger than it need be";
}

TEST(RoughNumber, KnowsNoSignOfWhatVanishes)
{
  bool sure = true;
  EXPECT_EQ((RoughNumber(0x1p-600) * RoughNumber(0x1p-600)).sign(sure), 0);
  EXPECT_FALSE(sure);
  sure = true;
  EXPECT_EQ(RoughNumber(0.0).sign(sure), 0);
  EXPECT_TRUE(sure);
}

} // namespace
} // namespace pcl_bsh
