// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace pcl_bsh::fuzz {

/// The seed's random bytes: the same on every machine.
inline std::vector<std::uint8_t> randomInput(std::uint32_t seed)
{
  constexpr std::size_t bytes = 128;
  std::mt19937 random(seed);
  std::vector<std::uint8_t> input(bytes);
  for (std::uint8_t& byte : input) byte = static_cast<std::uint8_t>(random());
  return input;
}

} // namespace pcl_bsh::fuzz
