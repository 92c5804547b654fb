// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/json/nearest_name.h>

#include <gtest/gtest.h>

namespace pcl_bsh::io {

TEST(NearestName, EditDistance)
{
  EXPECT_EQ(editDistance("", ""), 0U);
  EXPECT_EQ(editDistance("leaf", ""), 4U);
  EXPECT_EQ(editDistance("", "leaf"), 4U);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(editDistance("leafsize", "leaf_size"), 1U);
  EXPECT_EQ(editDistance("LEAF", "leaf"), 0U);
}

TEST(NearestName, IsFoundWithAndWithoutPrefix)
{
  const std::vector<std::string> valid = {"readers.pcd", "filters.voxel_grid", "pcl::VoxelGrid", "filters.crop_box"};
  EXPECT_EQ(nearestName("filters.voxelgrid", valid), "filters.voxel_grid");
  EXPECT_EQ(nearestName("crop_bx", valid), "filters.crop_box");
  EXPECT_EQ(nearestName("VoxelGrid", valid), "pcl::VoxelGrid");
  EXPECT_EQ(nearestName(std::string(100000, 'x') + "pcd", valid).empty(), false);
  EXPECT_EQ(nearestName("x", {}), "");
  EXPECT_EQ(suggestion("crop", valid), "did you mean 'filters.crop_box'?");
  EXPECT_EQ(suggestion("crop", {}), "there is none to name");
}

} // namespace pcl_bsh::io
