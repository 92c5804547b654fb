// SPDX-License-Identifier: BSD-3-Clause
// Float coordinates near an origin of their own: how points are stored, and how far a stored one is from the given one.
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <array>

namespace pcl_bsh {

/// The relative error of a stored coordinate: that of the cast. The room of relativeError() for double arithmetic
/// covers the subtraction.
inline constexpr double kStoringError = relativeError(1);

/// A point p of a cloud is stored as the float x nearest to (p - origin) / unit.
///
/// Rounding bound: |(p - origin) / unit - x| <= slack per axis. The double subtraction errs by v |p - origin| and the
/// cast by u of what it rounds, so kStoringError of the reach covers both; 2^-148 covers the cast of denormals.
struct LocalFrame {
  std::array<double, 3> origin = {0, 0, 0};
  double unit = 1.0;                       ///< a power of two; 1 unless the cloud is of extreme size
  std::array<double, 3> reach = {0, 0, 0}; ///< at least |x| of every stored point, per axis, in units
  bool lossless = false;                   ///< origin + x is p, for every point

  double slack(int axis) const noexcept { return kStoringError * reach[static_cast<unsigned>(axis)] + 0x1p-148; }
};

} // namespace pcl_bsh
