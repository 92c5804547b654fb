// SPDX-License-Identifier: BSD-3-Clause
// Cells of equal width along an axis, by their numbers.
#pragma once

#include <cstdint>

namespace pcl_bsh {

/// A triangle is put into cells that it misses by this share of their width, which is far above what double arithmetic
/// gets wrong.
inline constexpr double kCellPad = 0x1p-12;

/// The cell that holds x, of `count` that begin at `low`, `per` for each unit; the first and the last stand for what
/// lies beyond, and the first for what is not a number.
inline std::uint32_t cellAlong(double x, double low, double per, std::uint32_t count) noexcept
{
  const double i = (x - low) * per;
  return i >= 0.0 ? (i < count ? static_cast<std::uint32_t>(i) : count - 1) : 0;
}

} // namespace pcl_bsh
