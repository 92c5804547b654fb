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
              "ignore: '" + text +
                  "' is no pair of names: give FIRST:SECOND, where * is any letters and \\: a colon within a name");
  EXPECT_EQ(test::refusalOf([] { IgnoredPairs({"press:m*"}, {"press"}); }),
            "ignore: 'm*' matches no obstacle: give input, or one of their names");
}

TEST(IgnoredPairs, HaveColonsInNames)
{
  const std::vector<std::string> names = {"press:1", "press:2", R"(C:\plant*)", "C:other", "mill"};
  const IgnoredPairs ignored({R"(press\:1:mill)", R"(C\:\plant\*:input)"}, names);
  EXPECT_TRUE(ignored.holds("mill", "press:1"));
  EXPECT_FALSE(ignored.holds("mill", "press:2"));
  EXPECT_TRUE(ignored.holds("input", R"(C:\plant*)")) << "a backslash before a letter is itself";
  EXPECT_FALSE(ignored.holds("input", "C:other"));
  EXPECT_TRUE(IgnoredPairs({R"(C\:\\plant\*:mill)"}, names).holds(R"(C:\plant*)", "mill"));
  EXPECT_TRUE(IgnoredPairs({R"(press\:*:mill)"}, names).holds("press:2", "mill"));
  for (const char* const text : {R"(press\:1)", R"(press\:1\:mill)", "press:1:mill", R"(press\:1:)"})
    EXPECT_THROW(IgnoredPairs({text}, names), InvalidInput) << text;
}

TEST(ObstacleNames, FitPatterns)
{
  const std::vector<std::string> names = {"press:1", "press:2", "mill"};
  EXPECT_EQ(fittingNames("only", {"press:*"}, names), (std::vector<bool>{true, true, false}));
  EXPECT_EQ(fittingNames("only", {R"(press\:2)", "m*"}, names), (std::vector<bool>{false, true, true}));
  EXPECT_EQ(test::refusalOf([&] {
              fittingNames("only", {"press:1", "press"}, names);
            }),
            "only: 'press' matches no obstacle: give one of their names");
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
