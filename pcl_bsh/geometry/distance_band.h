// SPDX-License-Identifier: BSD-3-Clause
// The band of squared float distances in which a float comparison proves nothing.
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

/// Limits of squared float distances between points of two local frames. Outside of the band, they prove on which side
/// of the reach (a clearance, a radius) a distance is.
struct DistanceBand {
  float hit = -1.0f; ///< squared float distance <= hit: within the reach
  float miss = 0.0f; ///< squared float distance > miss: beyond it; anything between, NaN too, is undecided
};

/// Float and double arithmetic of the kernels keep their relative bounds while values stay within this range.
inline bool inFloatRange(double value) noexcept
{
  return std::abs(value) <= 0x1p60;
}

/// The band for a vector that is known within `error`: a hit proves a length of at most low_d, a miss one above high_d.
/// Squared float distances err by kSquaredDistanceError. Its room for double arithmetic covers the arithmetic here. All
/// in the frame's units; error is finite and >= 0.
inline DistanceBand distanceBand(double low_d, double high_d, double error) noexcept
{
  DistanceBand band;
  const double low = (low_d - error) - kFewDoubleRoundings * (low_d + error);
  const double hit = (1.0 - kSquaredDistanceError) * low * low - kSmallestSquare;
  band.hit = low > 0.0 && hit >= 0.0 ? std::min(roundDown(hit), std::numeric_limits<float>::max()) : -1.0f;
  const double high = (high_d + error) * (1.0 + kFewDoubleRoundings);
  const double miss = (1.0 + kSquaredDistanceError) * high * high + kSmallestSquare;
  band.miss = miss >= 3.4e38 ? std::numeric_limits<float>::infinity() : roundUp(miss);
  return band;
}

/// The band for a map that changes lengths by a factor of 1 +- skew at most: z is the true vector, w its image, known
/// in float within `error`. So |z| <= d follows from |w| <= d (1 - skew), |z| > d from |w| > d (1 + skew). All is
/// undecided where the error is infinite or d is out of range. @param d >= 0, not NaN
inline DistanceBand skewedBand(double d, double error, double skew) noexcept
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(error < infinity) || !inFloatRange(d)) return {-1.0f, std::numeric_limits<float>::infinity()};
  return distanceBand(d * (1.0 - skew), d * (1.0 + skew), error);
}

} // namespace pcl_bsh
