// SPDX-License-Identifier: BSD-3-Clause
// The descent of nodes with lists: each point is told of once, in the visitor's order, whatever ends the walk.
#include "support/random_clouds.h"

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <gtest/gtest.h>

#include <hwy/highway.h>

#include <pcl_bsh/traversal/list_walk-inl.h>

#include <algorithm>
#include <vector>

namespace pcl_bsh::HWY_NAMESPACE {
namespace {

struct NotedVisit : ListVisit<int> {};

/// Counts what it is told of the points of a voxel.
struct ListNotes : ListVisitor<NotedVisit> {
  struct Part {
    const Node& node;
    bool is_part;
  };

  const Voxel& voxel;
  std::uint64_t tested = 0;
  std::vector<int> compared, left_over, free_of_all;
  std::vector<std::uint32_t> order; ///< of leaves, their first points
  std::size_t deepest = 0;
  bool has_parts = false, goes_back = false;
  std::size_t done = 0; ///< inner children

  explicit ListNotes(const Voxel& of) : voxel(of), compared(of.count), left_over(of.count), free_of_all(of.count) {}

  static void add(std::vector<int>& told, std::uint32_t begin, std::uint32_t end)
  {
    for (std::uint32_t i = begin; i < end; ++i) ++told[i];
  }

  // As ListWalk asks.

  void left(const Part& part, const std::vector<int>& list)
  {
    EXPECT_FALSE(list.empty());
    add(left_over, part.node.begin[0], part.node.begin[part.node.count]);
  }

  template <class Descend>
  bool divides(const Part& part, const Descend& descend)
  {
    if (!has_parts || part.is_part) return false;
    for (int i = 0; i < 2; ++i) descend(Part{part.node, true});
    return true;
  }

  /// Nothing is near the last of several children.
  std::uint32_t refine(NotedVisit& visit, const Part& part, const std::vector<int>& list)
  {
    ++tested;
    visit.begin(part.node);
    for (std::uint32_t lane = 0; lane < part.node.count; ++lane)
      if (lane == 0 || lane + 1 < part.node.count) visit.near[lane] = list;
    return (1u << part.node.count) - 1;
  }

  std::uint32_t childAt(const NotedVisit& visit, std::uint32_t i) const
  {
    return goes_back ? visit.node->count - 1 - i : i;
  }

  void alone(const NotedVisit& visit, std::uint32_t lane)
  {
    add(free_of_all, visit.node->begin[lane], visit.node->begin[lane + 1]);
  }

  void compare(const Part& part, const NotedVisit& visit, std::uint32_t lane, std::size_t depth)
  {
    EXPECT_TRUE((visit.leaves >> lane & 1) != 0 && part.node.isLeaf(lane));
    deepest = std::max(deepest, depth);
    order.push_back(part.node.begin[lane]);
    add(compared, part.node.begin[lane], part.node.begin[lane + 1]);
  }

  Part below(const Part& part, const NotedVisit&, std::uint32_t lane) const
  {
    return {voxel.nodes[part.node.child[lane]], part.is_part};
  }

  void settled(const Part&, std::uint32_t) { ++done; }
};

class ListWalkTest : public testing::Test {
protected:
  void walk(ListNotes& notes, const Accuracy& accuracy)
  {
    const StopRule rule(accuracy);
    ListWalk<NotedVisit> walk(rule, notes.tested, visits_);
    walk.descend(notes, ListNotes::Part{notes.voxel.nodes[0], false}, std::vector<int>{1});
    for (std::size_t i = 0; i < notes.compared.size(); ++i)
      ASSERT_EQ(notes.compared[i] + notes.left_over[i] + notes.free_of_all[i], notes.has_parts ? 2 : 1) << i;
  }

  static std::ptrdiff_t countOf(const std::vector<int>& told)
  {
    return std::count_if(told.begin(), told.end(), [](int n) { return n > 0; });
  }

  test::Random random_{5};
  const test::Cloud points_{test::makePoints(test::Shape::sphere, 3000, 1, random_)};
  const SphereHierarchy cloud_{points_.view()};
  Work work_;
  const Voxel& voxel_ = cloud_.storage().built(0, work_);
  Visits<NotedVisit> visits_;
};

TEST_F(ListWalkTest, TakesEachLeafOnce)
{
  ListNotes notes(voxel_), back(voxel_), parts(voxel_);
  walk(notes, Accuracy::exact());
  EXPECT_EQ(countOf(notes.left_over), 0);
  EXPECT_GT(countOf(notes.compared), 0);
  EXPECT_GT(countOf(notes.free_of_all), 0);
  EXPECT_EQ(notes.done + 1, notes.tested);
  EXPECT_TRUE(std::is_sorted(notes.order.begin(), notes.order.end()));
  back.goes_back = true;
  walk(back, Accuracy::exact());
  EXPECT_EQ(std::vector<std::uint32_t>(back.order.rbegin(), back.order.rend()), notes.order);
  parts.has_parts = true;
  walk(parts, Accuracy::exact());
  EXPECT_EQ(parts.order.size(), 2 * notes.order.size());
}

TEST_F(ListWalkTest, LeavesWhatIsTooDeep)
{
  ListNotes whole(voxel_);
  walk(whole, Accuracy::exact());
  ASSERT_GE(whole.deepest, 2u);
  for (const unsigned level : {0u, 1u, 2u}) {
    ListNotes notes(voxel_);
    walk(notes, Accuracy::level(level));
    EXPECT_GT(countOf(notes.left_over), 0) << level;
    EXPECT_TRUE(notes.order.empty() || notes.deepest < level) << level;
  }
}

TEST_F(ListWalkTest, LeavesWhatABudgetDoesNotPay)
{
  ListNotes whole(voxel_);
  walk(whole, Accuracy::exact());
  for (const std::uint64_t nodes : {std::uint64_t{0}, std::uint64_t{1}, whole.tested / 2, whole.tested}) {
    ListNotes notes(voxel_);
    walk(notes, Accuracy::nodePairs(nodes));
    EXPECT_EQ(notes.tested, nodes);
    EXPECT_EQ(countOf(notes.left_over) == 0, nodes == whole.tested);
  }
}

} // namespace
} // namespace pcl_bsh::HWY_NAMESPACE
