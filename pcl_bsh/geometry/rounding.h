// SPDX-License-Identifier: BSD-3-Clause
// Directed rounding and error-free sums and products: the ground that every bound in this room stands on.
#pragma once

#include <pcl_bsh/simd/roundings.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef __FAST_MATH__
#error "pcl_bsh decides collisions exactly and cannot be compiled with -ffast-math"
#endif

namespace pcl_bsh {

inline constexpr double kDoubleUnit = 0x1p-53; ///< v: unit roundoff of double

/// Relative room for a handful of roundings in double where nothing is gained by counting them: 8192 v.
inline constexpr double kDoubleMargin = 0x1p-40;
/// Covers at most seven roundings in double, counted where this is used, and the rounding of its own product: 8 v.
inline constexpr double kFewDoubleRoundings = 8 * kDoubleUnit;

/// The float nearest to x. Keeps the rounding: g++ may drop it from a plain cast to float and back when it vectorises
/// two lanes of straight-line code.
inline float roundToFloat(double x) noexcept
{
  float rounded = static_cast<float>(x);
#if defined(__GNUC__) && defined(__SSE__)
  asm("" : "+x"(rounded));
#elif defined(__GNUC__)
  asm("" : "+m"(rounded));
#endif
  return rounded;
}

/// The float `steps` floats farther from 0 than x, or nearer where `steps` < 0. @pre there is one of the same sign
inline float stepAwayFromZero(float x, std::int32_t steps) noexcept
{
  std::int32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits += steps;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// The smallest float that is not below x.
inline float roundUp(double x) noexcept
{
  const float rounded = roundToFloat(x);
  const std::int32_t is_below = static_cast<double>(rounded) < x; // for half of all x: no branch, and no nextafter()
  return stepAwayFromZero(rounded, std::signbit(rounded) ? -is_below : is_below);
}

/// The largest float that is not above x.
inline float roundDown(double x) noexcept
{
  const float rounded = roundToFloat(x);
  const std::int32_t is_above = static_cast<double>(rounded) > x;
  return stepAwayFromZero(rounded, std::signbit(rounded) ? is_above : -is_above);
}

/// Error of a distance enclosed in double arithmetic, relative to the absolute sum of all terms:
/// ExactDistance::enclose().
inline constexpr double kTermsError = 32 * kDoubleUnit;

/// A double with the error of the operation that made it.
struct WithError {
  double value = 0.0;
  double error = 0.0;
};

/// value + error = a + b exactly, barring overflow (Knuth).
inline WithError twoSum(double a, double b) noexcept
{
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// value + error = a * b exactly, barring overflow and underflow (fused multiply-add, in software where need be).
inline WithError twoProduct(double a, double b) noexcept
{
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

} // namespace pcl_bsh
