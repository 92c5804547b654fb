// SPDX-License-Identifier: BSD-3-Clause
// The difference of a root and a length, good enough to begin with: nearestDouble() makes it exact.
#pragma once

#include <pcl_bsh/geometry/exact/dyadic.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

/// sqrt(numerator / denominator) - length within a few units in the last place; infinite or 0 where doubles have no
/// such number. @pre denominator > 0, length >= 0, and the two differ
inline double roughRootLess(const Dyadic& numerator, const Dyadic& denominator, const Dyadic& length)
{
  // As a quotient, so that the only cancellation happens in exact arithmetic; by exponents, for the root may be beyond
  // all doubles where the difference is not.
  const auto left = (numerator - denominator * (length * length)).scaled();
  const auto n = numerator.scaled(), d = denominator.scaled(), shorter = length.scaled();
  const int squared_exponent = n.exponent - d.exponent, odd = squared_exponent & 1;
  const double root = std::sqrt(std::ldexp(n.mantissa / d.mantissa, odd));
  const int root_exponent = (squared_exponent - odd) / 2, exponent = std::max(root_exponent, shorter.exponent);
  const double sum =
      std::ldexp(root, root_exponent - exponent) + std::ldexp(shorter.mantissa, shorter.exponent - exponent);
  return std::ldexp(left.mantissa / d.mantissa / sum, left.exponent - d.exponent - exponent);
}

} // namespace pcl_bsh
