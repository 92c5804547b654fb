// SPDX-License-Identifier: BSD-3-Clause
// States, not calls: what was built, refitted, updated, moved and shared before must not show in any answer.
#include "../fuzz/sequence.h"

#include <gtest/gtest.h>

#include <exception>
#include <random>
#include <vector>

namespace pcl_bsh {
namespace {

/// The input of `replay_sequences --random`, likewise.
std::vector<std::uint8_t> randomInput(std::uint32_t seed)
{
  std::mt19937 random(seed);
  std::vector<std::uint8_t> input(400);
  for (std::uint8_t& byte : input) byte = static_cast<std::uint8_t>(random());
  return input;
}

TEST(Sequences, SameAsBruteForceAfterEveryStep)
{
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const std::vector<std::uint8_t> input = randomInput(seed);
    fuzz::Bytes bytes(input.data(), input.size());
    try {
      fuzz::runSequence(bytes);
    }
    catch (const std::exception& error) {
      FAIL() << "sequence " << seed << ": " << error.what();
    }
  }
}

} // namespace
} // namespace pcl_bsh
