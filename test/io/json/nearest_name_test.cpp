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
  EXPECT_EQ(nearestName(std::string(100000, 'x') + "pcd", valid), "filters.voxel_grid") << "by its beginning";
  EXPECT_EQ(nearestName("x", {}), "");
  EXPECT_EQ(suggestion("crop", valid), "did you mean 'filters.crop_box'?");
  EXPECT_EQ(suggestion("crop", {}), "no name exists");
}

TEST(NearestName, TakesTheFirstOfThoseAsNear)
{
  EXPECT_EQ(nearestName("aa", {"ab", "ac"}), "ab");
  EXPECT_EQ(nearestName("aa", {"bb", "ac", "ab"}), "ac");
  EXPECT_EQ(nearestName("aa", {"bb"}), "bb") << "however far";
}

TEST(NearestName, PartsOfThreeLettersCountAsOneMistake)
{
  EXPECT_EQ(nearestName("box", {"boa", "filters.crop_box_of_all"}), "boa") << "one letter, too, and before";
  EXPECT_EQ(nearestName("box", {"bea", "filters.crop_box_of_all"}), "filters.crop_box_of_all");
  EXPECT_EQ(nearestName("bo", {"cea", "filters.crop_box_of_all"}), "cea") << "two letters are no part";
  EXPECT_EQ(nearestName("a.box", {"a.bea", "filters.a.box_of_all"}), "a.bea") << "with a prefix the whole name counts";
}

TEST(NearestName, PrefixesCountForThoseAlone)
{
  EXPECT_EQ(nearestName("crop_bx", {"crap_by__", "filters.crop_box"}), "filters.crop_box");
  EXPECT_EQ(nearestName("filters.crop_bx", {"crop_bx", "filters.crop_box"}), "filters.crop_box");
}

TEST(NearestName, ListsNames)
{
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed({"a"}), "a");
  EXPECT_EQ(listed({"a", "b", "c"}), "a, b, c");
}

} // namespace pcl_bsh::io
