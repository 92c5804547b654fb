// SPDX-License-Identifier: BSD-3-Clause
// The double nearest to a number that can be compared, but not written down.
#pragma once

#include <pcl_bsh/geometry/exact/dyadic.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pcl_bsh {

/// The double nearest to a number (ties to even; infinity beyond the largest). @param guess near it, not NaN
/// @param side called with a Dyadic: the sign of the number less it
template <class Side>
double nearestDouble(double guess, const Side& side)
{
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // Halfway to the next double above; the one above the largest counts as 2^1024.
  const auto halfway_above = [](double x) {
    const Dyadic above = x < largest ? Dyadic(std::nextafter(x, largest)) : Dyadic(0x1p1023) * Dyadic(2.0);
    return (Dyadic(x) + above) * Dyadic(0.5);
  };
  const auto belongs_above = [&](double x) {
    const int found = side(halfway_above(x));
    return found > 0 || (found == 0 && (std::bit_cast<std::uint64_t>(x) & 1) != 0);
  };
  double rounded = std::min(guess, largest);
  while (rounded < infinity && belongs_above(rounded)) rounded = std::nextafter(rounded, infinity);
  while (rounded > -infinity && !belongs_above(std::nextafter(rounded, -infinity)))
    rounded = std::nextafter(rounded, -infinity);
  return rounded;
}

} // namespace pcl_bsh
