// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/collision_field.h>

#include "clouds.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace pcl_bsh {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

pcl::PCLPointCloud2 threePoints()
{
  return *fieldCloud<double>({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
}

auto refusedWith(const std::string& text)
{
  return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
}

TEST(CollisionField, IsAddedAtTheEndOfEachRecord)
{
  const pcl::PCLPointCloud2 cloud = threePoints();
  const pcl::PCLPointCloud2 result = withField(cloud, "collision", test::verdictsOf({1, 0, 1}));

  ASSERT_EQ(result.fields.size(), cloud.fields.size() + 1);
  EXPECT_EQ(result.fields.back().name, "collision");
  EXPECT_EQ(result.fields.back().datatype, pcl::PCLPointField::UINT8);
  EXPECT_EQ(result.fields.back().count, 1u);
  EXPECT_EQ(result.fields.back().offset, cloud.point_step);
  EXPECT_EQ(result.header.frame_id, cloud.header.frame_id);
  EXPECT_EQ(result.width, 3u);
  EXPECT_EQ(result.height, 1u);
  EXPECT_EQ(result.row_step, 3 * result.point_step);
  const std::vector<std::uint8_t> flags = {1, 0, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    auto expected = record(cloud, i);
    expected.push_back(flags[i]);
    EXPECT_EQ(record(result, i), expected) << i;
  }
}

TEST(CollisionField, SeveralOfSeveralTypes)
{
  const pcl::PCLPointCloud2 cloud = threePoints();
  const std::vector<std::int32_t> poses = {-1, 7, 8};
  const std::vector<float> distances = {0.5f, 0.25f, 0.125f};
  pcl::PCLPointCloud2 result = withFields(cloud, {{"pose", &poses}, {"distance", &distances}});
  ASSERT_EQ(result.fields.size(), cloud.fields.size() + 2);
  EXPECT_EQ(result.point_step, cloud.point_step + 8);
  // Fields that are there already take the new values.
  const std::vector<float> nearer = {0.1f, 0.2f, 0.3f};
  result = withFields(result, {{"distance", &nearer}});
  EXPECT_EQ(result.point_step, cloud.point_step + 8);
  for (std::size_t i = 0; i < 3; ++i) {
    auto expected = record(cloud, i);
    for (const void* value : {static_cast<const void*>(&poses[i]), static_cast<const void*>(&nearer[i])}) {
      const auto* const first = static_cast<const std::uint8_t*>(value);
      expected.insert(expected.end(), first, first + 4);
    }
    EXPECT_EQ(record(result, i), expected) << i;
  }
  EXPECT_THAT(([&] {
                withFields(result, {{"pose", &nearer}});
              }),
              refusedWith("field 'pose' exists already and is not one FLOAT32"));
  EXPECT_THAT(([&] {
                withFields(result, {{"distance", &poses}});
              }),
              refusedWith("field 'distance' exists already and is not one INT32"));
}

TEST(CollisionField, KeepsRowsAndDensity)
{
  pcl::PCLPointCloud2 cloud = threePoints();
  cloud.width = 1;
  cloud.height = 3;
  cloud.row_step = cloud.point_step;
  cloud.is_dense = 1;
  const pcl::PCLPointCloud2 result = withField(cloud, "collision", test::verdictsOf({0, 0, 1}));
  EXPECT_EQ(result.height, 3u);
  EXPECT_EQ(result.row_step, result.point_step);
  EXPECT_EQ(result.is_dense, 1);
}

TEST(CollisionField, NewValuesReplaceOldOnes)
{
  const pcl::PCLPointCloud2 once = withField(threePoints(), "collision", test::verdictsOf({1, 0, 1}));
  const pcl::PCLPointCloud2 twice = withField(once, "collision", test::verdictsOf({0, 1, 1}));
  EXPECT_EQ(twice.data, withField(threePoints(), "collision", test::verdictsOf({0, 1, 1})).data);
  EXPECT_EQ(twice.fields.size(), once.fields.size());
}

TEST(CollisionField, RefusesAFieldOfAnotherType)
{
  EXPECT_THAT(
      [] {
        withField(threePoints(), "intensity", test::verdictsOf({1, 0, 1}));
      },
      refusedWith("field 'intensity' exists already and is not one UINT8 per point"));
  pcl::PCLPointCloud2 cloud = withField(threePoints(), "collision", test::verdictsOf({1, 0, 1}));
  cloud.fields.back().count = 0; // one, as PCL once wrote it
  EXPECT_NO_THROW(withField(cloud, "collision", test::verdictsOf({1, 0, 1})));
  cloud.fields.back().count = 2;
  EXPECT_THAT(
      [&] {
        withField(cloud, "collision", test::verdictsOf({1, 0, 1}));
      },
      refusedWith("field 'collision' exists already and is not one UINT8 per point"));
  cloud.fields.back().count = 1;
  cloud.fields.back().offset = cloud.point_step;
  EXPECT_THAT(
      [&] {
        withField(cloud, "collision", test::verdictsOf({1, 0, 1}));
      },
      refusedWith("field 'collision' exists already"));
}

TEST(CollisionField, RefusesAnotherNumberOfValues)
{
  EXPECT_THAT(
      [] {
        withField(threePoints(), "collision", test::verdictsOf({1, 0}));
      },
      refusedWith("field 'collision' has 2 values: the cloud has 3 points"));
}

TEST(CollisionField, EmptyCloud)
{
  const pcl::PCLPointCloud2 result = withField(*fieldCloud<float>({}), "collision", {});
  EXPECT_TRUE(result.data.empty());
  EXPECT_EQ(result.fields.back().name, "collision");
}

} // namespace
} // namespace pcl_bsh
