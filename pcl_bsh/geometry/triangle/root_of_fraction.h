// SPDX-License-Identifier: BSD-3-Clause
// Roots of squared distances that are fractions: compared exactly, and rounded.
#pragma once

#include <pcl_bsh/geometry/exact/rounded_length.h>
#include <pcl_bsh/geometry/triangle/nearest_features.h>

#include <cmath>
#include <limits>

namespace pcl_bsh {

/// Sign of the root of a fraction less a length. @param squared >= 0
template <class Number>
int compareRoot(const Fraction<Number>& squared, const Number& length, bool& sure)
{
  if (signOf(length, sure) < 0) return 1;
  return signOf(squared.numerator - squared.denominator * (length * length), sure);
}

/// The root of a fraction, rounded to the nearest double; NaN where that is in doubt.
///
/// The quotient q of the values is corrected by what is left of the numerator, n - q d, as LongNumber has it, over d.
/// The correction is rounded by v twice, and divided by d's value, which is off by v of d: 4 v of the correction. The
/// error of n - q d stays as it is.
inline double nearestRoot(const Fraction<LongNumber>& squared)
{
  const LongNumber &n = squared.numerator, &d = squared.denominator;
  if (n.value() == 0.0 && n.tail() == 0.0 && n.error() == 0.0) return 0.0;
  const double quotient = n.value() / d.value();
  if (!(quotient > 0x1p-800 && quotient < 0x1p800 && d.value() > 0x1p-400 && d.value() < 0x1p400))
    return std::numeric_limits<double>::quiet_NaN();
  const LongNumber left = n - LongNumber(quotient) * d;
  const double correction = (left.value() + left.tail()) / d.value();
  const double error = 2.0 * left.error() / d.value() + 8 * kDoubleUnit * std::abs(correction);
  return roundedRoot(quotient, correction, error);
}

/// Sign of sqrt(x) + shift - sqrt(y).
inline int compareShiftedRoots(const Fraction<Dyadic>& x, const Dyadic& shift, const Fraction<Dyadic>& y)
{
  bool always = true;
  if (shift.sign() == 0) return compareFractions(x, y, always);
  if (shift.sign() < 0) return -compareShiftedRoots(y, -shift, x);
  // Both sides are >= 0, so their squares compare alike, here times both denominators.
  const Dyadic both = x.denominator * y.denominator, square = shift * shift;
  const Dyadic rational = x.numerator * y.denominator + square * both - y.numerator * x.denominator;
  const Dyadic irrational_squared = Dyadic(4.0) * square * x.numerator * y.denominator * both;
  return rational.sign() >= 0 ? (rational + irrational_squared).sign()
                              : (irrational_squared - rational * rational).sign();
}

} // namespace pcl_bsh
