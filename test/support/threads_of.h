// SPDX-License-Identifier: BSD-3-Clause
// Whether something runs on several threads: oneTBB makes them when a loop first needs them, and keeps them.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>

namespace pcl_bsh {

inline bool hasOtherThreads()
{
  const std::filesystem::directory_iterator threads("/proc/self/task");
  return std::distance(begin(threads), end(threads)) > 1;
}

/// Expects that `use`, in a process of its own, makes other threads, or makes none. The process runs the whole test
/// again until it comes here, and ends: what must be removed then is static.
template <typename Use>
void expectOtherThreads(bool expected, const Use& use)
{
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto run = [&] {
    use();
    std::exit(hasOtherThreads() == expected ? 0 : 1);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(0), "") << (expected ? "one thread" : "several threads");
}

} // namespace pcl_bsh
