// SPDX-License-Identifier: BSD-3-Clause
// States, not calls: what was built, refitted, updated, moved and shared before must not show in any answer.
#include "../fuzz/random_input.h"
#include "../fuzz/sequence.h"

#include <gtest/gtest.h>

#include <exception>
#include <vector>

namespace pcl_bsh {
namespace {

void expectSound(std::uint32_t seeds, bool surfaces)
{
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    const std::vector<std::uint8_t> input = fuzz::randomInput(seed);
    fuzz::Bytes bytes(input.data(), input.size());
    try {
      fuzz::runSequence(bytes, surfaces);
    }
    catch (const std::exception& error) {
      FAIL() << "sequence " << seed << ": " << error.what();
    }
  }
}

TEST(Sequences, SameAsBruteForceAfterEveryStep)
{
  expectSound(200, false);
}

TEST(Sequences, OfSurfacesAndSolids)
{
  expectSound(30, true);
}

} // namespace
} // namespace pcl_bsh
