// SPDX-License-Identifier: BSD-3-Clause
// Contexts from the number of returns of a pulse and the number of one of them. Many files count from 0, know only one
// of the two, or exchange them. So all pairs have a context, and the order does not matter.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace pcl_bsh::io::laz {

/// The context of up to 7 returns, one of 16.
constexpr unsigned returnContext10(unsigned returns, unsigned number)
{
  const unsigned least = std::min(returns, number), most = std::max(returns, number);
  if (least == 0) return 15 - most;
  if (most <= 5) return most * (most - 1) / 2 + least - 1;
  return least + (most == 6 ? 9 : 8);
}

/// The context of up to 15 returns, one of 6.
constexpr unsigned returnContext14(unsigned returns, unsigned number)
{
  const unsigned least = std::min(returns, number), most = std::max(returns, number);
  if (least == 0) {
    constexpr std::array<unsigned, 10> alone = {0, 1, 2, 3, 4, 5, 3, 4, 4, 5};
    return alone[std::min(most, 9U)];
  }
  if (least == 1) return most <= 2 ? most - 1 : 3;
  if (least == 2) return most == 2 ? 2 : most <= 10 ? 4 : 3;
  return most == least || (most == least + 1 && least >= 11) ? 5 : 4;
}

/// A table for returns below `Size`.
template <std::size_t Size, typename Context>
constexpr std::array<std::array<std::uint8_t, Size>, Size> returnTable(Context context)
{
  std::array<std::array<std::uint8_t, Size>, Size> table{};
  for (unsigned returns = 0; returns < Size; ++returns)
    for (unsigned number = 0; number < Size; ++number)
      table[returns][number] = static_cast<std::uint8_t>(context(returns, number));
  return table;
}

/// How far the number of a return is from the number of returns, 7 at most: 8 contexts.
constexpr unsigned returnLevel(unsigned returns, unsigned number)
{
  return std::min(returns > number ? returns - number : number - returns, 7U);
}

} // namespace pcl_bsh::io::laz
