// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace pcl_bsh {

inline constexpr unsigned kMortonBits = 21; ///< per axis

/// In place of a cell's number or code: outside of the grid.
inline constexpr std::uint64_t kOutsideGrid = ~std::uint64_t{0};

/// Spreads 21 bits so that two zeros follow each.
inline std::uint64_t spreadBits(std::uint64_t v) noexcept
{
  v &= 0x1fffff;
  v = (v | v << 32) & 0x001f00000000ffff;
  v = (v | v << 16) & 0x001f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  v = (v | v << 2) & 0x1249249249249249;
  return v;
}

/// The inverse of spreadBits(); bits in between are ignored.
inline std::uint64_t gatherBits(std::uint64_t v) noexcept
{
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10c30c30c30c30c3;
  v = (v | v >> 4) & 0x100f00f00f00f00f;
  v = (v | v >> 8) & 0x001f0000ff0000ff;
  v = (v | v >> 16) & 0x001f00000000ffff;
  v = (v | v >> 32) & 0x1fffff;
  return v;
}

/// Interleaves the bits of three cell numbers below 2^21; x in the lowest.
inline std::uint64_t mortonCode(std::uint64_t x, std::uint64_t y, std::uint64_t z) noexcept
{
  return spreadBits(x) | spreadBits(y) << 1 | spreadBits(z) << 2;
}

} // namespace pcl_bsh
