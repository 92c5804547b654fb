// SPDX-License-Identifier: BSD-3-Clause
#include "support/refusal.h"

#include <pcl_bsh/question/obstacle_names.h>

#include <gmock/gmock.h>

namespace pcl_bsh {
namespace {

using testing::StartsWith;

TEST(IgnoredPairs, MatchNamesInBothOrders)
{
  const IgnoredPairs ignored({"press:c*", "*l:input"}, {"press", "crane", "mill", "c"});
  EXPECT_TRUE(ignored.holds("press", "crane"));
  EXPECT_TRUE(ignored.holds("c", "press"));
  EXPECT_FALSE(ignored.holds("press", "mill"));
  EXPECT_TRUE(ignored.holds(kInputName, "mill"));
  EXPECT_FALSE(ignored.holds(kInputName, "press"));
  EXPECT_FALSE(IgnoredPairs().holds("press", "crane"));
}

TEST(IgnoredPairs, RefuseWhatIsNoPair)
{
  for (const std::string text : {"press", ":press", "press:", "a:b:c", ""})
    EXPECT_EQ(test::refusalOf([&] {
                IgnoredPairs({text}, {"press", "a", "b", "c"});
              }),
              "ignore: '" + text + "' is no pair of names: give FIRST:SECOND, where * is any letters");
  EXPECT_EQ(test::refusalOf([] { IgnoredPairs({"press:m*"}, {"press"}); }),
            "ignore: 'm*' matches no obstacle: give input, or one of their names");
}

TEST(ObstacleNames, RefuseOnesThatTellNothingApart)
{
  EXPECT_NO_THROW(checkObstacleNames({"a", "b"}));
  EXPECT_EQ(test::refusalOf([] {
              checkObstacleNames({"a", "b", "a"});
            }),
            "obstacles: two obstacles have the name 'a': give each its own");
  EXPECT_THAT(test::refusalOf([] { checkObstacleNames({"input"}); }), StartsWith("obstacles: 'input' is"));
  EXPECT_THAT(test::refusalOf([] { checkObstacleNames({""}); }), StartsWith("obstacles: one has no name"));
}

} // namespace
} // namespace pcl_bsh
