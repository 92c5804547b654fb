// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/float_environment.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace pcl_bsh {
namespace {

// volatile: computed when the program runs, in the environment of the moment.
double quotient(double x, double y)
{
  const volatile double numerator = x, denominator = y;
  return numerator / denominator;
}

TEST(DefaultFloatEnvironment, RoundsToNearestAndGivesTheCallersModeBack)
{
  const double nearest = quotient(1, 3);
  std::fesetround(FE_UPWARD);
  const double up = quotient(1, 3);
  double inside = 0;
  {
    const DefaultFloatEnvironment environment;
    inside = quotient(1, 3);
  }
  const double after = quotient(1, 3);
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(inside, nearest);
  EXPECT_GT(up, nearest);
  EXPECT_EQ(after, up);
}

TEST(DefaultFloatEnvironment, LeavesTheCallersExceptionFlagsAlone)
{
  std::feclearexcept(FE_ALL_EXCEPT);
  {
    const DefaultFloatEnvironment environment;
    EXPECT_TRUE(std::isinf(quotient(1, 0)));
  }
  EXPECT_EQ(std::fetestexcept(FE_DIVBYZERO), 0);
}

#ifdef __SSE2__
TEST(DefaultFloatEnvironment, KeepsDenormals)
{
  constexpr double smallest_normal = std::numeric_limits<double>::min();
  constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | flush_to_zero | denormals_are_zero);
  const double flushed = quotient(smallest_normal, 2);
  double inside = 0;
  {
    const DefaultFloatEnvironment environment;
    inside = quotient(quotient(smallest_normal, 2), 0.5);
  }
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(flushed, 0.0);
  EXPECT_EQ(inside, smallest_normal);
  EXPECT_EQ(after & (flush_to_zero | denormals_are_zero), flush_to_zero | denormals_are_zero);
}
#endif

} // namespace
} // namespace pcl_bsh
