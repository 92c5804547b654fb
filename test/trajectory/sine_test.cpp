// SPDX-License-Identifier: BSD-3-Clause
// The C library's sine and cosine against enclosures in integers: what kSineError takes them for.
#include <pcl_bsh/trajectory/pose_path.h>

#include "support/random.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace pcl_bsh {
namespace {

using Integer = boost::multiprecision::cpp_int;

constexpr int kPlaces = 240; ///< binary ones of fixed-point numbers

Integer fixedOf(double x)
{
  int exponent = 0;
  const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  return Integer(digits) << (kPlaces + exponent - 53); // exact of all that is above 2^-187
}

/// By the series. The omitted terms are less than 2^-180, and so are the digits that divisions drop: 40 times less than
/// a unit of 2^-240, which grows with the terms, by e^6.4.
/// @param first 0 of the cosine, 1 of the sine
Integer valueOf(double angle, int first)
{
  const Integer x = fixedOf(angle);
  Integer term = first == 0 ? Integer(1) << kPlaces : x, sum = term;
  for (int n = first + 2; n < 80; n += 2) { // 6.4^80 / 80! < 2^-180
    term = -((((term * x) >> kPlaces) * x) >> kPlaces) / (n * (n - 1));
    sum += term;
  }
  return sum;
}

TEST(Sine, OfTheLibraryErrsByLessThanIsAssumed)
{
  test::Random random(801);
  double most = 0.0;
  const auto check = [&](double angle) {
    const std::pair<double, int> values[] = {{std::cos(angle), 0}, {std::sin(angle), 1}};
    for (const auto& [value, first] : values) {
      const Integer off = abs(fixedOf(value) - valueOf(angle, first));
      const double error = std::ldexp(static_cast<double>(off), -kPlaces);
      ASSERT_LE(error, kSineError) << angle;
      most = std::max(most, error);
    }
  };
  for (int i = 0; i < 5000; ++i) check(random.uniform(0.0, 6.3));
  for (int i = 1; i <= 8; ++i) // near the places where they are 0, 1 and -1, and tiny angles
    for (int k = -3; k <= 3; ++k) {
      check(i * 0.78539816339744831 + k * 0x1p-40);
      check(std::ldexp(1.0 + k / 8.0, -10 * i));
    }
  std::printf("sine and cosine err by %.2f units of double at most, of %.0f that are assumed\n", most / 0x1p-53,
              kSineError / 0x1p-53);
}

} // namespace
} // namespace pcl_bsh
