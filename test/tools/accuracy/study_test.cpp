// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/accuracy/study.h>

#include <gtest/gtest.h>

namespace pcl_bsh::accuracy {
namespace {

TEST(AccuracyStudy, ASpreadIsThatOfThePosesMedians)
{
  const Spread poses = spreadOfPoses({{1, 1, 90}, {2, 2, 2}, {3, 3, 3}, {80, 4, 4}, {5, 5, 5}});
  EXPECT_EQ(poses.low, 2.0);
  EXPECT_EQ(poses.median, 3.0);
  EXPECT_EQ(poses.high, 4.0);
  const Spread one = spreadOfPoses({{5, 1, 2, 4, 3}});
  EXPECT_EQ(one.low, 2.0);
  EXPECT_EQ(one.high, 4.0);
}

} // namespace
} // namespace pcl_bsh::accuracy
