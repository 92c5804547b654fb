// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/large_array.h>

#include <pcl_bsh/base/retained_memory.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

namespace pcl_bsh {
namespace {

LargeArray<std::uint32_t> upTo(std::uint32_t count)
{
  LargeArray<std::uint32_t> items;
  items.append(count);
  std::iota(items.begin(), items.end(), 0u);
  return items;
}

void expectUpTo(const LargeArray<std::uint32_t>& items, std::uint32_t count)
{
  ASSERT_EQ(items.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(items[i], i);
}

TEST(LargeArray, KeepsItsItemsAsItGrows)
{
  LargeArray<std::uint32_t> items;
  EXPECT_TRUE(items.empty());
  for (std::uint32_t i = 0; i < 100000; ++i) {
    items.reserveMore(1);
    items.push(i);
  }
  expectUpTo(items, 100000);
  EXPECT_LT(items.bytes(), 2 * 100100 * sizeof(std::uint32_t));
}

TEST(LargeArray, AppendsBehindTheLastOne)
{
  LargeArray<std::uint32_t> items = upTo(10);
  std::uint32_t* const more = items.append(3);
  EXPECT_EQ(more, items.begin() + 10);
  std::iota(more, items.end(), 10u);
  expectUpTo(items, 13);
  EXPECT_EQ(items.bytes(), 13 * sizeof(std::uint32_t));
}

TEST(LargeArray, HasTheRoomThatWasReserved)
{
  LargeArray<std::uint32_t> items = upTo(10);
  items.reserve(50);
  EXPECT_EQ(items.bytes(), 50 * sizeof(std::uint32_t));
  const std::uint32_t* const before = items.data();
  items.reserve(20);
  items.append(40);
  EXPECT_EQ(items.data(), before);
  items.clear();
  EXPECT_EQ(items.bytes(), 50 * sizeof(std::uint32_t));
}

TEST(LargeArray, GivesBackRoomBeyondItsItems)
{
  LargeArray<std::uint32_t> items = upTo(10);
  items.reserve(50);
  items.shrink(50);
  EXPECT_EQ(items.bytes(), 50 * sizeof(std::uint32_t));
  items.shrink(20);
  EXPECT_EQ(items.bytes(), 20 * sizeof(std::uint32_t));
  items.shrink(0);
  EXPECT_EQ(items.bytes(), 10 * sizeof(std::uint32_t));
  expectUpTo(items, 10);
}

#ifndef __SANITIZE_ADDRESS__ // there, every buffer is the system's own
TEST(LargeArray, LeavesLargeMemoryForOtherUses)
{
  releaseRetainedMemory();
  const std::uint32_t* const first = upTo(2 << 20).data();
  EXPECT_GE(retainedMemory(), std::size_t{8} << 20);
  EXPECT_EQ(upTo(2 << 20).data(), first);
}
#endif

} // namespace
} // namespace pcl_bsh
