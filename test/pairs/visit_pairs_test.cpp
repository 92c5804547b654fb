// SPDX-License-Identifier: BSD-3-Clause
// The loop over pairs of nodes: what a visitor prunes is not looked below, and where it stops the walk can go on.
#include "support/random_clouds.h"

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <gtest/gtest.h>

#include <hwy/highway.h>

#include <pcl_bsh/traversal/visit_pairs-inl.h>

#include <set>
#include <tuple>

namespace pcl_bsh::HWY_NAMESPACE {
namespace {

using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

Key keyOf(const LanePair& pair)
{
  return {pair.a.space, pair.a.node, pair.a.lane, pair.b.space, pair.b.node, pair.b.lane};
}

/// Notes the pairs that it looks at; stops after so many, and prunes some.
struct Notes : PairVisitor {
  PairWalk& walk;
  double within;
  std::size_t patience = 0;
  std::vector<Key> seen;
  std::size_t most = 0; ///< pairs, 0: no limit
  bool prunes = false;
  std::size_t leaves = 0;

  explicit Notes(PairWalk& of, double reach) : walk(of), within(reach) {}

  double reach() const { return within; }
  Next visit(const LanePair& pair)
  {
    if (most != 0 && patience == 0) return Next::stop;
    --patience;
    seen.push_back(keyOf(pair));
    return prunes && seen.size() % 3 == 0 ? Next::prune : Next::go_on;
  }
  Next compare(const LanePair& pair)
  {
    leaves += walk.compare(pair).near != 0;
    return Next::go_on;
  }
};

class VisitPairs : public testing::Test {
protected:
  std::vector<LanePair> seeds(PairWalk& walk) const
  {
    std::vector<LanePair> stack;
    walk.seed(kReach, [&](const LanePair& pair, const PairWalk::Step&, std::uint32_t) { stack.push_back(pair); });
    nearestLast(stack, 0);
    return stack;
  }

  static constexpr double kReach = 0.1;
  test::Random random_{5};
  const test::Cloud points_a_{test::makePoints(test::Shape::sphere, 3000, 1, random_)},
      points_b_{test::makePoints(test::Shape::sphere, 3000, 1, random_)};
  const SphereHierarchy cloud_a_{points_a_.view()}, cloud_b_{points_b_.view()};
  const Placed a_{cloud_a_}, b_{cloud_b_};
};

TEST_F(VisitPairs, GoesOnWhereItStopped)
{
  PairWalk walk(a_, b_), again(a_, b_);
  std::vector<LanePair> stack = seeds(walk);
  Notes all(walk, kReach);
  visitPairs(walk, stack, all);
  EXPECT_TRUE(stack.empty());
  EXPECT_GT(all.seen.size(), 1000u);
  EXPECT_GT(all.leaves, 100u);
  EXPECT_EQ(std::set<Key>(all.seen.begin(), all.seen.end()).size(), all.seen.size()) << "a pair was visited twice";

  stack = seeds(again);
  Notes some(again, kReach);
  some.most = 7;
  for (std::size_t rounds = 0; !stack.empty() && rounds < all.seen.size(); ++rounds) {
    some.patience = some.most;
    visitPairs(again, stack, some);
  }
  EXPECT_EQ(some.seen, all.seen);
  EXPECT_EQ(some.leaves, all.leaves);
  EXPECT_EQ(walk.work.node_pairs, again.work.node_pairs);
}

TEST_F(VisitPairs, LooksNotBelowWhatIsPruned)
{
  PairWalk walk(a_, b_), again(a_, b_);
  std::vector<LanePair> stack = seeds(walk);
  Notes all(walk, kReach);
  visitPairs(walk, stack, all);
  stack = seeds(again);
  Notes pruned(again, kReach);
  pruned.prunes = true;
  visitPairs(again, stack, pruned);
  EXPECT_TRUE(stack.empty());
  EXPECT_LT(pruned.seen.size(), all.seen.size());
  const std::set<Key> known(all.seen.begin(), all.seen.end());
  for (const Key& key : pruned.seen) EXPECT_EQ(known.count(key), 1u);
}

} // namespace
} // namespace pcl_bsh::HWY_NAMESPACE
