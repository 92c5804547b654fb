// SPDX-License-Identifier: BSD-3-Clause
// The queue of a search that goes best first: in the order of keys, the last first among equals, however often it
// forgets what was taken.
#include "support/random.h"

#include <gtest/gtest.h>

#include <hwy/highway.h>

#include <pcl_bsh/traversal/pair_queue-inl.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace pcl_bsh::HWY_NAMESPACE {
namespace {

LanePair pairOf(float key, std::uint32_t number)
{
  return {key, {number, 1, 2}, {3, number, 4}};
}

TEST(PairQueue, SmallestKeysFirstAndTheLastOfEquals)
{
  test::Random random(11);
  PairQueue queue;
  std::vector<LanePair> expected; // the next one last
  std::uint32_t number = 0;
  for (int step = 0; step < 30000; ++step) {
    if (random.chance(0.52)) {
      const float infinity = std::numeric_limits<float>::infinity();
      const float key = random.chance(0.02) ? -infinity : static_cast<float>(random.integer(-20, 20)) / 8;
      const LanePair pair = pairOf(key, number++);
      queue.push(pair);
      const auto after = std::find_if(expected.begin(), expected.end(), [&](const LanePair& p) { return p.key < key; });
      expected.insert(after, pair); // behind those of the same key, before the smaller ones
      continue;
    }
    ASSERT_EQ(queue.size(), expected.size());
    ASSERT_EQ(queue.isEmpty(), expected.empty());
    if (expected.empty()) continue;
    ASSERT_EQ(queue.least(), expected.back().key);
    const LanePair taken = queue.pop();
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
  EXPECT_EQ(queue.least(), std::numeric_limits<float>::infinity());
}

} // namespace
} // namespace pcl_bsh::HWY_NAMESPACE
