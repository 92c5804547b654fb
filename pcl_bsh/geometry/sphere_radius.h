// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/local_frame.h>

#include <cmath>

namespace pcl_bsh {

/// An upper bound, except for underflow (kSmallestLength), of a length whose square is `squared` in float arithmetic.
inline double lengthOver(float squared) noexcept
{
  return std::sqrt(static_cast<double>(squared)) * (1.0 + kLengthError);
}

/// At least the distance of every given point to a float centre, in a frame's units.
///
/// @param squared the largest |x - c|^2 over the stored points, in float arithmetic.
/// @param slack by storedSlack(), which pays for what underflows
inline double radiusOver(float squared, double slack) noexcept
{
  return lengthOver(squared) + slack;
}

/// How far a given point may be from where a frame stores it, along all axes together.
inline double storedSlack(const LocalFrame& frame) noexcept
{
  double squared = 0.0;
  for (int k = 0; k < 3; ++k) squared += frame.slack(k) * frame.slack(k);
  return std::sqrt(squared) * (1.0 + kFewDoubleRoundings) + kSmallestLength;
}

} // namespace pcl_bsh
