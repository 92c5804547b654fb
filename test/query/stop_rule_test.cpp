// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/stop_rule.h>
#include <pcl_bsh/query/uncertain.h>

#include <gmock/gmock.h>

namespace pcl_bsh {
namespace {

constexpr std::uint64_t kNever = StopRule::kNever;

TEST(StopRule, OfTimeIsOverAtItsEnd)
{
  const StopRule over(Accuracy::time(0.0)), endless(Accuracy::time(1e300)); // more than a clock can count
  EXPECT_TRUE(over.mayStop() && over.isTimed() && over.isOver() && over.isSpent(0));
  EXPECT_FALSE(over.leavesTimeToBuild(0));
  EXPECT_TRUE(endless.mayStop() && endless.isTimed());
  EXPECT_FALSE(endless.isOver() || endless.isSpent(kNever - 1));
  EXPECT_TRUE(endless.leavesTimeToBuild(1000));
  EXPECT_FALSE(endless.leavesTimeToBuild(std::size_t{1} << 60)); // 2000 years
  EXPECT_FALSE(endless.part(0.5).isOver());
  EXPECT_TRUE(endless.part(0.0).isOver());
}

TEST(StopRule, OfSphereTestsIsSpentAtTheirNumber)
{
  const StopRule rule(Accuracy::nodePairs(10));
  EXPECT_TRUE(rule.mayStop());
  EXPECT_FALSE(rule.isTimed() || rule.isOver());
  EXPECT_FALSE(rule.isSpent(9));
  EXPECT_TRUE(rule.isSpent(10));
  EXPECT_EQ(rule.part(0.5).node_pairs, 5u);
  EXPECT_EQ(rule.deepest, kNever);
  EXPECT_TRUE(rule.leavesTimeToBuild(std::size_t{1} << 60));
  EXPECT_THAT(rule.passes(), testing::ElementsAre(0u, 2u, kNever));
  std::uint64_t tested = 9;
  StopCheck check(rule, tested);
  EXPECT_FALSE(check.isOver());
  tested = 10;
  EXPECT_TRUE(check.isOver());
  tested = 0;
  EXPECT_TRUE(check.isOver()) << "once over, always over";
}

TEST(StopRule, OfMoreThanCanBeCountedNeverStops)
{
  EXPECT_EQ(StopRule(Accuracy::parse("pairs=9223372036854774784")).node_pairs, 0x7ffffffffffffc00u); // below 2^63
  EXPECT_EQ(StopRule(Accuracy::parse("pairs=9223372036854775808")).node_pairs, kNever);
  EXPECT_EQ(StopRule(Accuracy::parse("level=1e300")).deepest, kNever);
}

TEST(StopRule, TwoSearchesHaveHalfOfABudgetEach)
{
  EXPECT_EQ(halfOf(Accuracy::nodePairs(10)).value, 5.0);
  EXPECT_EQ(halfOf(Accuracy::time(3.0)).value, 1.5);
  EXPECT_EQ(halfOf(Accuracy::level(4)).value, 4.0);
  EXPECT_EQ(halfOf(Accuracy::tolerance(0.5)).value, 0.5);
}

TEST(StopRule, ChecksOfTimeEndAfterIt)
{
  const std::uint64_t tested = 0;
  const StopRule endless(Accuracy::time(1e300)), over(Accuracy::time(0.0)), soon(Accuracy::time(0.002));
  StopCheck goes_on(endless, tested), ends(over, tested), ends_soon(soon, tested);
  for (int step = 0; step < 10000; ++step) ASSERT_FALSE(goes_on.isOver());
  EXPECT_TRUE(ends.isOver());
  while (!ends_soon.isOver()) continue;
  EXPECT_TRUE(soon.isOver());
  EXPECT_TRUE(ends_soon.isOver()) << "once over, always over";
}

TEST(StopRule, OfALevelOpensNodesDownToIt)
{
  const StopRule rule(Accuracy::level(3));
  EXPECT_TRUE(rule.mayStop());
  EXPECT_EQ(rule.deepest, 3u);
  EXPECT_THAT(rule.passes(), testing::ElementsAre(3u));
  EXPECT_FALSE(rule.isTimed() || rule.isSpent(kNever - 1));
}

TEST(StopRule, OfExactAnswersNeverStops)
{
  for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::tolerance(1.0)}) {
    const StopRule rule(accuracy);
    EXPECT_FALSE(rule.mayStop() || rule.isTimed() || rule.isOver() || rule.isSpent(kNever - 1));
    EXPECT_EQ(rule.part(0.5).node_pairs, kNever);
    const std::uint64_t tested = kNever;
    EXPECT_FALSE(StopCheck(rule, tested).isOver());
  }
}

} // namespace
} // namespace pcl_bsh
