// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/exact/long_number.h>

#include <pcl_bsh/geometry/exact/dyadic.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

/// A number and what it stands for.
struct Known {
  LongNumber number;
  Dyadic exact;
};

void expectWithinError(const Known& known)
{
  const LongNumber& n = known.number;
  const Dyadic off = known.exact - Dyadic(n.value()) - Dyadic(n.tail());
  const Dyadic error(n.error());
  EXPECT_LE((off - error).sign(), 0) << n.value();
  EXPECT_LE((-off - error).sign(), 0) << n.value();
  bool sure = true;
  const int sign = n.sign(sure);
  if (sure) {
    EXPECT_EQ(sign, known.exact.sign());
  }
}

TEST(LongNumber, KnowsItsError)
{
  test::Random random(401);
  for (int round = 0; round < 3000; ++round) {
    std::vector<Known> known;
    for (int k = 0; k < 4; ++k) {
      const double x = std::ldexp(random.uniform(-1, 1), random.integer(-40, 40));
      known.push_back({LongNumber(x), Dyadic(x)});
    }
    for (int k = 0; k < 12; ++k) {
      const Known& x = known[static_cast<std::size_t>(random.integer(0, static_cast<int>(known.size()) - 1))];
      const Known& y = known[static_cast<std::size_t>(random.integer(0, static_cast<int>(known.size()) - 1))];
      const int what = random.integer(0, 2);
      const Known made = what == 0   ? Known{x.number + y.number, x.exact + y.exact}
                         : what == 1 ? Known{x.number - y.number, x.exact - y.exact}
                                     : Known{x.number * y.number, x.exact * y.exact};
      if (std::abs(made.number.value()) > 0x1p300) continue;
      expectWithinError(made);
      known.push_back(made);
    }
  }
}

/// Errors of numbers are added where these are, and multiplied: all of them, and hardly more.
TEST(LongNumber, HasTheErrorsOfItsParts)
{
  const LongNumber x(1.0, 0.0, 0x1p-60), y(-3.0, 0.0, 0x1p-62);
  const auto expectError = [](const LongNumber& number, double error) {
    EXPECT_GE(number.error(), error);
    EXPECT_LE(number.error(), error * (1.0 + 1e-6));
  };
  expectError(x + y, 0x1p-60 + 0x1p-62);
  expectError(x - y, 0x1p-60 + 0x1p-62);
  expectError(-x, 0x1p-60);
  expectError(x * y, 3 * 0x1p-60 + 0x1p-62);
}

/// So that what lies across an axis is known to, whatever the other axes have.
TEST(LongNumber, OfNothingIsNothing)
{
  const LongNumber zero, far(1e300), rough(3.0, 1e-17, 1e-20), overflown = far * far;
  ASSERT_FALSE(std::isfinite(overflown.value()));
  for (const LongNumber& x : {zero, far, rough, overflown}) {
    EXPECT_TRUE((zero * x).isZero());
    EXPECT_TRUE((x * zero).isZero());
  }
  EXPECT_FALSE((LongNumber(0.0, 0.0, 1e-20) * rough).isZero()); // which may be nothing
  EXPECT_FALSE((rough * LongNumber(0x1p-1000)).isZero());
}

TEST(LongNumber, IsExactWhereTwoDoublesAre)
{
  bool sure = true;
  const LongNumber x(0x1p53 + 2), y(3.0), z = x * y;
  EXPECT_EQ(z.error(), 0.0);
  EXPECT_EQ((z - y * x).sign(sure), 0);
  EXPECT_EQ((z - LongNumber(0x1p55)).sign(sure), -1);
  EXPECT_TRUE(sure);
  const LongNumber third = z * z * z; // more than two doubles hold
  EXPECT_GT(third.error(), 0.0);
  EXPECT_EQ((third - z * z * z).sign(sure), 0);
  EXPECT_FALSE(sure);
}

TEST(LongNumber, IsUnsureBeyondItsRange)
{
  for (const double x : {1e-200, 1e200}) {
    bool sure = true;
    const LongNumber square = LongNumber(x) * LongNumber(x);
    EXPECT_EQ((square - LongNumber(x) * LongNumber(x)).sign(sure), 0);
    EXPECT_FALSE(sure) << x;
    sure = true;
    EXPECT_EQ((square * square).sign(sure), 0); // what is not known does not vanish
    EXPECT_FALSE(sure) << x;
  }
}

} // namespace
} // namespace pcl_bsh
