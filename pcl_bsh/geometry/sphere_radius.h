// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/local_frame.h>

#include <cmath>

namespace pcl_bsh {

/// At least the distance of every given point to a float centre, in a frame's units.
///
/// @param squared the largest |x - c|^2 over the stored points, in float arithmetic. Differences err by u of
/// themselves,
///   squares and their two sums by 3 u more: under 6 u together, fused or not, so under 3 u (1 + 6 u) of the root. What
///   underflows is below 2^-73. 2^-21 = 8 u of the root, and the slack's own 2^-60, pay for both.
/// @param slack by storedSlack()
inline double radiusOver(float squared, double slack) noexcept
{
  return std::sqrt(static_cast<double>(squared)) * (1.0 + 0x1p-21) + slack;
}

/// How far a given point may be from where a frame stores it, along all axes together.
inline double storedSlack(const LocalFrame& frame) noexcept
{
  double squared = 0.0;
  for (int k = 0; k < 3; ++k) squared += frame.slack(k) * frame.slack(k);
  return std::sqrt(squared) * (1.0 + 0x1p-50) + 0x1p-60;
}

} // namespace pcl_bsh
