// SPDX-License-Identifier: BSD-3-Clause
// The queue of a search that goes best first: in the order of keys, the last first among equals, however often it
// forgets what was taken; what was put in together stays so.
#include "support/random.h"

#include <gtest/gtest.h>

#include <hwy/highway.h>

#include <pcl_bsh/traversal/pair_queue-inl.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace pcl_bsh::HWY_NAMESPACE {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Children of a's or b's node, which the number names, with these keys.
WaitingChildren childrenOf(std::uint32_t number, bool of_a, std::uint8_t which, const std::vector<float>& keys)
{
  WaitingChildren children{{0.0f, {number, 1, 2}, {3, number, 4}}, of_a, which, {}};
  std::copy(keys.begin(), keys.end(), children.keys);
  return children;
}

WaitingChildren oneOf(float key, std::uint32_t number)
{
  return childrenOf(number, true, 1u << 2, {0.0f, 0.0f, key});
}

TEST(PairQueue, SmallestKeysFirstAndTheLastOfEquals)
{
  test::Random random(11);
  PairQueue queue;
  std::vector<LanePair> expected; // the next one last
  std::uint32_t number = 0;
  for (int step = 0; step < 30000; ++step) {
    if (random.chance(0.52)) {
      const float key = random.chance(0.02) ? -kInfinity : static_cast<float>(random.integer(-20, 20)) / 8;
      const WaitingChildren one = oneOf(key, number++);
      queue.push(one);
      const auto after = std::find_if(expected.begin(), expected.end(), [&](const LanePair& p) { return p.key < key; });
      expected.insert(after, one.child(2)); // behind those of the same key, before the smaller ones
      continue;
    }
    ASSERT_EQ(queue.size(), expected.size());
    ASSERT_EQ(queue.isEmpty(), expected.empty());
    if (expected.empty()) continue;
    ASSERT_EQ(queue.least(), expected.back().key);
    const LanePair taken = queue.pop();
    ASSERT_EQ(taken.key, expected.back().key);
    ASSERT_EQ(taken.a.space, expected.back().a.space);
    ASSERT_EQ(taken.b.node, expected.back().b.node);
    expected.pop_back();
  }
  ASSERT_GT(expected.size(), 100u);
  std::vector<LanePair> stack;
  queue.drainTo(stack);
  ASSERT_EQ(stack.size(), expected.size());
  for (std::size_t i = 0; i < stack.size(); ++i) EXPECT_EQ(stack[i].a.space, expected[i].a.space) << i;
  EXPECT_TRUE(queue.isEmpty());
  EXPECT_EQ(queue.least(), kInfinity);
}

TEST(PairQueue, ChildrenComeOneByOneEachInItsTurn)
{
  test::Random random(12);
  PairQueue queue;
  std::vector<float> expected;
  for (std::uint32_t step = 0; step < 20000; ++step) {
    if (random.chance(0.2)) {
      std::vector<float> keys(kLanes);
      for (float& key : keys) key = static_cast<float>(random.integer(-1000000, 1000000));
      const auto which = static_cast<std::uint8_t>(random.integer(1, 255));
      queue.push(childrenOf(step, random.chance(0.5), which, keys));
      for (std::uint32_t i = 0; i < kLanes; ++i)
        if ((which >> i & 1u) != 0) expected.push_back(keys[i]);
      std::sort(expected.begin(), expected.end());
    }
    ASSERT_EQ(queue.isEmpty(), expected.empty());
    if (expected.empty()) continue;
    ASSERT_EQ(queue.least(), expected.front());
    ASSERT_EQ(queue.pop().key, expected.front());
    expected.erase(expected.begin());
  }
}

TEST(PairQueue, TellsWhichChildItIs)
{
  PairQueue queue;
  queue.push(childrenOf(9, false, 0b1010, {5, 4, 3, 2}));
  queue.push(childrenOf(8, true, 0b1, {3}));
  LanePair pair = queue.pop();
  EXPECT_EQ(pair.key, 2.0f);
  EXPECT_EQ(pair.a.lane, 2u);
  EXPECT_EQ(pair.b.lane, 3u);
  pair = queue.pop();
  EXPECT_EQ(pair.a.space, 8u);
  EXPECT_EQ(pair.a.lane, 0u);
  EXPECT_EQ(pair.b.lane, 4u);
  pair = queue.pop();
  EXPECT_EQ(pair.key, 4.0f);
  EXPECT_EQ(pair.b.lane, 1u);
  EXPECT_TRUE(queue.isEmpty());
}

TEST(PairQueue, KeysBelowTheFloorAreEqualButAmongThemselves)
{
  PairQueue queue(0.0f);
  queue.push(childrenOf(1, true, 0b11, {-5, -4}));
  queue.push(childrenOf(2, true, 0b11, {-1, -2}));
  EXPECT_EQ(queue.least(), 0.0f);
  std::vector<float> keys;
  while (!queue.isEmpty()) keys.push_back(queue.pop().key);
  EXPECT_EQ(keys, (std::vector<float>{-2, -1, -5, -4}));
}

} // namespace
} // namespace pcl_bsh::HWY_NAMESPACE
