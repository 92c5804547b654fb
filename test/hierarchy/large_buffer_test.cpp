// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/large_buffer.h>

#include <pcl_bsh/base/retained_memory.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr std::size_t kLarge = 8 << 20;

TEST(LargeBuffer, HoldsWhatWasAskedFor)
{
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, std::size_t{64}, std::size_t{4 << 20}, kLarge + 1}) {
    const LargeBuffer<unsigned char> buffer = makeBuffer<unsigned char>(bytes);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.get()) % 64, 0u);
    EXPECT_GE(buffer.get_deleter().size, bytes);
    for (std::size_t i = 0; i < bytes; i += 4096) buffer[i] = 1;
  }
}

TEST(LargeBuffer, KeepsNoMoreThanItMay)
{
  std::vector<LargeBuffer<float>> buffers;
  for (std::size_t bytes = 0; bytes <= 2 * retainedMemoryLimit(); bytes += kLarge)
    buffers.push_back(makeBuffer<float>(kLarge / sizeof(float)));
  buffers.push_back(makeBuffer<float>(retainedMemoryLimit() / sizeof(float) + 1));
  buffers.clear();
  EXPECT_LE(retainedMemory(), retainedMemoryLimit());
}

#ifndef __SANITIZE_ADDRESS__ // there, every buffer is the system's own
TEST(LargeBuffer, IsUsedAgain)
{
  const float* const first = makeBuffer<float>(kLarge / sizeof(float)).get();
  const std::size_t kept = retainedMemory();
  EXPECT_GE(kept, kLarge);
  const LargeBuffer<float> again = makeBuffer<float>(kLarge / sizeof(float) - 100);
  EXPECT_EQ(again.get(), first);
  EXPECT_EQ(retainedMemory(), kept - again.get_deleter().size);
}

/// A sensor's frame is kept, too; small buffers are not.
TEST(LargeBuffer, IsKeptFromAQuarterOfAMegabyte)
{
  releaseRetainedMemory();
  makeBuffer<unsigned char>((256 << 10) - 64);
  EXPECT_EQ(retainedMemory(), 0u);
  makeBuffer<unsigned char>(256 << 10);
  EXPECT_EQ(retainedMemory(), std::size_t{256 << 10});
}
#endif

TEST(LargeBuffer, IsNobodyElses)
{
  std::vector<LargeBuffer<unsigned char>> buffers;
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < 12; ++i) {
      buffers.push_back(makeBuffer<unsigned char>(kLarge - (i << 18)));
      buffers.back()[0] = buffers.back()[buffers.back().get_deleter().size - 1] = static_cast<unsigned char>(i);
    }
    for (std::size_t i = 0; i < 12; ++i) {
      EXPECT_EQ(buffers[i][0], i);
      EXPECT_EQ(buffers[i][buffers[i].get_deleter().size - 1], i);
    }
    buffers.clear();
  }
}

} // namespace
} // namespace pcl_bsh
