// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/search/selected_records.h>

#include <gtest/gtest.h>

#include <numeric>

namespace pcl_bsh {
namespace {

/// Two rows of three records of four bytes, 0 1 2 3, 4 5 6 7 and so on.
pcl::PCLPointCloud2 numberedBytes()
{
  pcl::PCLPointCloud2 cloud;
  cloud.header.frame_id = "scanner";
  cloud.width = 3;
  cloud.height = 2;
  cloud.point_step = 4;
  cloud.row_step = 12;
  cloud.is_dense = 1;
  cloud.fields.emplace_back();
  cloud.fields.back().name = "label";
  cloud.data.resize(24);
  std::iota(cloud.data.begin(), cloud.data.end(), std::uint8_t{0});
  return cloud;
}

TEST(SelectedRecords, KeepTheirBytesInTheOrderAskedFor)
{
  const pcl::PCLPointCloud2 selected = selectedRecords(numberedBytes(), {4, 1});
  EXPECT_EQ(selected.width, 2u);
  EXPECT_EQ(selected.height, 1u);
  EXPECT_EQ(selected.row_step, 8u);
  EXPECT_EQ(selected.data, (std::vector<std::uint8_t>{16, 17, 18, 19, 4, 5, 6, 7}));
}

TEST(SelectedRecords, OfNoneIsACloudWithTheSameHeaderAndFields)
{
  for (const pcl::PCLPointCloud2& empty :
       {withoutRecords(numberedBytes()), selectedRecords(numberedBytes(), pcl::Indices())}) {
    EXPECT_EQ(empty.header.frame_id, "scanner");
    ASSERT_EQ(empty.fields.size(), 1u);
    EXPECT_EQ(empty.fields[0].name, "label");
    EXPECT_EQ(empty.point_step, 4u);
    EXPECT_EQ(empty.is_dense, 1);
    EXPECT_EQ(empty.width, 0u);
    EXPECT_EQ(empty.height, 1u);
    EXPECT_TRUE(empty.data.empty());
  }
  for (const std::uint8_t big : {std::uint8_t{0}, std::uint8_t{1}}) { // bytes are copied, in whatever order they are
    pcl::PCLPointCloud2 cloud = numberedBytes();
    cloud.is_bigendian = big;
    EXPECT_EQ(selectedRecords(cloud, {1}).is_bigendian, big);
  }
}

} // namespace
} // namespace pcl_bsh
