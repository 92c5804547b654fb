// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clashes/near_boxes.h>

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace pcl_bsh {
namespace {

std::vector<Extent> randomBoxes(std::size_t count, double longest, std::mt19937& random)
{
  std::uniform_real_distribution<double> place(-10, 10), length(0, longest);
  std::vector<Extent> boxes(count);
  for (Extent& box : boxes) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = place(random);
      box.high[k] = box.low[k] + length(random);
    }
  }
  return boxes;
}

TEST(Extent, IsNearUpToTheLengthItself)
{
  const Extent box{{0, 0, 0}, {1, 1, 1}};
  for (std::size_t k = 0; k < 3; ++k) {
    Extent other = box;
    other.low[k] = 1.5, other.high[k] = 2.0;
    EXPECT_TRUE(box.isNear(other, 0.5) && other.isNear(box, 0.5));
    EXPECT_FALSE(box.isNear(other, 0.499) || other.isNear(box, 0.499));
  }
}

TEST(NearBoxes, AreThoseOfComparingAll)
{
  std::mt19937 random(5);
  for (const std::size_t count : {0U, 1U, 4U, 5U, 100U, 777U}) {
    for (const double longest : {0.0, 1.0, 15.0}) {
      const std::vector<Extent> boxes = randomBoxes(count, longest, random);
      NearBoxes tree(boxes);
      for (const Extent& asked : randomBoxes(20, longest, random)) {
        std::set<std::size_t> near, expected;
        tree.visitNear(asked, 0.5, [&](std::size_t i) {
          EXPECT_TRUE(near.insert(i).second) << "visited twice";
          return false;
        });
        for (std::size_t i = 0; i < count; ++i)
          if (asked.isNear(boxes[i], 0.5)) expected.insert(i);
        EXPECT_EQ(near, expected);
      }
      EXPECT_EQ(tree.left(), count);
    }
  }
}

TEST(NearBoxes, ThatAreDoneAreNotVisitedAgain)
{
  std::mt19937 random(6);
  const std::vector<Extent> boxes = randomBoxes(300, 5, random);
  NearBoxes tree(boxes);
  std::set<std::size_t> done;
  for (const Extent& asked : randomBoxes(2000, 3, random)) {
    tree.visitNear(asked, 0.0, [&](std::size_t i) {
      EXPECT_TRUE(done.insert(i).second);
      return true;
    });
    EXPECT_EQ(tree.left(), boxes.size() - done.size());
  }
  EXPECT_GT(done.size(), 250U);
}

/// A row of boxes, every other one long: they are divided by their middles.
TEST(NearBoxes, CompareFew)
{
  std::vector<Extent> boxes(64);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto x = static_cast<double>(i);
    boxes[i] = {{x, 0, 0}, {x + (i % 2 == 0 ? 0.5 : 24.5), 1, 1}};
  }
  NearBoxes tree(boxes);
  for (const Extent& box : boxes) tree.visitNear({box.low, box.low}, 0.0, [](std::size_t) { return false; });
  EXPECT_EQ(tree.compared, 2486U);
  tree.visitNear({{0, 0, 0}, {100, 1, 1}}, 0.0, [](std::size_t) { return true; });
  const std::uint64_t before = tree.compared;
  tree.visitNear({{0, 0, 0}, {100, 1, 1}}, 0.0, [](std::size_t) { return true; });
  EXPECT_EQ(tree.compared, before) << "nothing is left";
}

} // namespace
} // namespace pcl_bsh
