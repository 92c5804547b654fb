// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>

#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

TEST(Counted, NounsOfOneAndMore)
{
  EXPECT_EQ(counted(0, "point"), "0 points");
  EXPECT_EQ(counted(1, "point"), "1 point");
  EXPECT_EQ(counted(2, "point"), "2 points");
  EXPECT_EQ(counted(1, "clash", "clashes"), "1 clash");
  EXPECT_EQ(counted(11, "clash", "clashes"), "11 clashes");
  EXPECT_EQ(counted(1, "point is", "points are"), "1 point is");
}

} // namespace
} // namespace pcl_bsh
