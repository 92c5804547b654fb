// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/cli/step.h>

#include <gmock/gmock.h>

namespace pcl_bsh::cli {

TEST(Step, IsSilentWhenShort)
{
  testing::internal::CaptureStderr();
  Step step("Loading a");
  EXPECT_LT(step.done("1 point"), 1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Step, TellsWhenLong)
{
  testing::internal::CaptureStderr();
  Step step("Loading a");
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  EXPECT_GT(step.done("1 point"), 1.1);
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_THAT(told, testing::MatchesRegex("> Loading a \\[done, [0-9]+ ms : 1 point\\]\n"));
}

TEST(Step, LeavesAWholeLineWhenItFails)
{
  testing::internal::CaptureStderr();
  {
    const Step step("Loading a");
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "> Loading a \n");
}

} // namespace pcl_bsh::cli
