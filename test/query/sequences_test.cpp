// SPDX-License-Identifier: BSD-3-Clause
// States, not calls: what was built, refitted, updated, moved and shared before must not show in any answer.
#include "../fuzz/random_input.h"
#include "../fuzz/sequence.h"

#include <gtest/gtest.h>

#include <exception>
#include <vector>

namespace pcl_bsh {
namespace {

TEST(Sequences, SameAsBruteForceAfterEveryStep)
{
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const std::vector<std::uint8_t> input = fuzz::randomInput(seed);
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
