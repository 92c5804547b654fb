// SPDX-License-Identifier: BSD-3-Clause
// Cells of equal width along an axis, by their numbers.
#pragma once

#include <cstdint>

namespace pcl_bsh {

/// A triangle is also put into cells that it misses by up to this share of their width: far more than double arithmetic
/// errs.
inline constexpr double kCellPad = 0x1p-12;

/// Returns the number of the cell that holds x. There are `count` cells from `low` on, `per` for each unit of length.
/// The first and the last also hold what lies beyond them, and NaN is in the first.
inline std::uint32_t cellAlong(double x, double low, double per, std::uint32_t count) noexcept
{
  const double i = (x - low) * per;
  return i >= 0.0 ? (i < count ? static_cast<std::uint32_t>(i) : count - 1) : 0;
}

} // namespace pcl_bsh
