// SPDX-License-Identifier: BSD-3-Clause
// Lengths rounded to the nearest double, from vectors known to about twice a double's digits: right, or no answer.
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <array>
#include <cmath>
#include <limits>

namespace pcl_bsh {

/// Limits of roundedRoot(). Where the low-order part of a square is below kMostLowOrder of it, the length errs by at
/// most kLengthDoubt of itself. Else nothing is known. Proved in test/proof/rounded_lengths.g.
inline constexpr double kMostLowOrder = 0x1p-50;
inline constexpr double kLengthDoubt = 0x1p-100;

/// A coordinate: value + tail, within `error`.
struct LongCoordinate {
  double value = 0.0, tail = 0.0, error = 0.0;
};

/// The double nearest to sqrt(square) - radii, where square is high + low within `error`. NaN where low is not below
/// kMostLowOrder of high, or where the error leaves in doubt which double that is. (Ziv's test: the rest of the last
/// rounding, with its error on either side, must not change the sum.)
///
/// The root of high + low is r + (high - r^2 + low) / 2 r within (low / high)^2 r. This is below 2^-100 r where |low|
/// <= 2^-50 high. high - r^2 is a double. Sizes are checked, so that nothing overflows, and what underflows is below
/// 2^-1000 beside squares of 2^-900.
inline double roundedRoot(double high, double low, double error, double radius_p = 0.0, double radius_q = 0.0) noexcept
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!(high > 0x1p-900 && high < 0x1p900 && std::abs(low) < kMostLowOrder * high)) return none;
  error += 0x1p-1000;
  const double root = std::sqrt(high);
  const double correction = (std::fma(-root, root, high) + low) / (2.0 * root);
  error = error / root + kLengthDoubt * root + 4 * kDoubleUnit * std::abs(correction);

  const WithError radii = twoSum(radius_p, radius_q);
  const WithError difference = twoSum(root, -radii.value);
  const double rest = difference.error + correction - radii.error;
  error += 4 * kDoubleUnit * (std::abs(difference.error) + std::abs(correction) + std::abs(radii.error));
  const WithError rounded = twoSum(difference.value, rest);
  const bool sure = rounded.value + (rounded.error + error) == rounded.value &&
                    rounded.value + (rounded.error - error) == rounded.value && std::abs(rounded.value) > 0x1p-400;
  return sure ? rounded.value : none;
}

/// The double nearest to |vector| - radii, where its error leaves no doubt which that is; else NaN.
///
/// A square is value^2, as two doubles, and 2 value tail + tail^2, which errs by four roundings of itself at most and
/// by 2 (|value| + |tail|) error. The sum of the squares is kept as two doubles; all that is of low order is added up
/// in `low`, whose absolute sum bounds its eight roundings.
inline double roundedLength(const std::array<LongCoordinate, 3>& vector, double radius_p, double radius_q) noexcept
{
  double high = 0.0, low = 0.0, size_of_low = 0.0, error = 0.0;
  bool zero = true;
  for (const LongCoordinate& c : vector) {
    const WithError square = twoProduct(c.value, c.value);
    const WithError sum = twoSum(high, square.value);
    const double mixed = (2.0 * c.value + c.tail) * c.tail;
    high = sum.value;
    low += sum.error + (square.error + mixed);
    size_of_low += std::abs(sum.error) + std::abs(square.error) + std::abs(mixed);
    zero = zero && c.value == 0.0 && c.tail == 0.0 && c.error == 0.0;
    const double length = std::abs(c.value) + std::abs(c.tail);
    error += 2.0 * length * c.error + c.error * c.error + 4 * kDoubleUnit * length * std::abs(c.tail) * 2.0;
  }
  if (zero) return 0.0 - (radius_p + radius_q);
  return roundedRoot(high, low, 2.0 * (error + 8 * kDoubleUnit * size_of_low), radius_p, radius_q);
}

} // namespace pcl_bsh
