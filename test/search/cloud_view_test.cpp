// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/search/cloud_view.h>

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using Field = pcl::PCLPointField;
using testing::HasSubstr;
using testing::ThrowsMessage;

template <typename PointT>
pcl::PointCloud<PointT> threePoints()
{
  pcl::PointCloud<PointT> cloud;
  cloud.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = static_cast<decltype(PointT::x)>(i);
    cloud[i].x = value + 1;
    cloud[i].y = 10 * value + 2;
    cloud[i].z = -value;
  }
  return cloud;
}

void expectThreePoints(const PointsView& view)
{
  ASSERT_EQ(view.count, 3u);
  ASSERT_EQ(view.size(), 3u);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(view.point(i), (Point3{i + 1.0, 10.0 * i + 2, -1.0 * i})) << i;
}

Field field(const std::string& name, std::size_t offset, std::uint8_t datatype, pcl::uindex_t count = 1)
{
  Field result;
  result.name = name;
  result.offset = static_cast<pcl::uindex_t>(offset);
  result.datatype = datatype;
  result.count = count;
  return result;
}

/// The three points as one row of packed records: z, a byte, y, x.
template <typename Coordinate>
pcl::PCLPointCloud2 packed(std::uint8_t datatype)
{
  const std::size_t bytes = sizeof(Coordinate);
  pcl::PCLPointCloud2 cloud;
  cloud.fields = {field("z", 0, datatype), field("ring", bytes, Field::UINT8), field("y", bytes + 1, datatype),
                  field("x", 2 * bytes + 1, datatype)};
  cloud.width = 3;
  cloud.height = 1;
  cloud.point_step = static_cast<pcl::uindex_t>(3 * bytes + 1);
  cloud.row_step = 3 * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = static_cast<Coordinate>(i);
    const std::array<Coordinate, 3> zyx = {-value, 10 * value + 2, value + 1};
    std::uint8_t* const record = &cloud.data[i * cloud.point_step];
    std::memcpy(record, &zyx[0], bytes);
    std::memcpy(record + bytes + 1, &zyx[1], 2 * bytes);
  }
  return cloud;
}

pcl::PCLPointCloud2 packedFloats()
{
  return packed<float>(Field::FLOAT32);
}

auto refusedWith(const std::string& text)
{
  return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
}

TEST(CloudView, TypedCloudOfFloats)
{
  const auto cloud = threePoints<pcl::PointXYZ>();
  const PointsView view = viewOf(cloud);
  EXPECT_EQ(view.data, cloud.points.data());
  EXPECT_EQ(view.scalar, Scalar::float32);
  expectThreePoints(view);
  expectThreePoints(viewOf(threePoints<pcl::PointXYZRGBNormal>()));
}

struct PointBackwards {
  std::uint8_t tag;
  double z;
  double y;
  double x;
};

TEST(CloudView, TypedCloudOfDoublesInAnyOrder)
{
  const auto cloud = threePoints<PointBackwards>();
  const PointsView view = viewOf(cloud);
  EXPECT_EQ(view.scalar, Scalar::float64);
  expectThreePoints(view);
}

TEST(CloudView, EmptyTypedCloud)
{
  EXPECT_EQ(viewOf(pcl::PointCloud<pcl::PointXYZ>()).size(), 0u);
}

TEST(CloudView, SubsetKeepsTheNumbersOfTheCloud)
{
  const auto cloud = threePoints<pcl::PointXYZ>();
  const pcl::Indices indices = {2, 0};
  const PointsView view = viewOf(cloud, indices);
  EXPECT_EQ(view.count, 3u);
  ASSERT_EQ(view.size(), 2u);
  EXPECT_EQ(view.record(0), 2u);
  EXPECT_EQ(view.point(view.record(1)), (Point3{1, 2, 0}));
}

TEST(CloudView, EmptySubsetNamesNoPoint)
{
  const PointsView view = viewOf(threePoints<pcl::PointXYZ>(), pcl::Indices());
  EXPECT_EQ(view.count, 3u);
  EXPECT_EQ(view.size(), 0u);
}

TEST(CloudView, FieldsOfATypedCloud)
{
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2(threePoints<pcl::PointXYZINormal>(), cloud);
  expectThreePoints(viewOf(cloud));
}

TEST(CloudView, FieldsPackedInAnyOrder)
{
  expectThreePoints(viewOf(packedFloats()));
  expectThreePoints(viewOf(packed<double>(Field::FLOAT64)));
}

TEST(CloudView, Float64KeepsEveryBit)
{
  auto cloud = packed<double>(Field::FLOAT64);
  const double northing = 5400000.26;
  std::memcpy(&cloud.data[9], &northing, sizeof northing);
  EXPECT_EQ(viewOf(cloud).point(0)[1], northing);
}

TEST(CloudView, MissingField)
{
  for (const std::size_t missing : {0u, 2u, 3u}) {
    auto cloud = packedFloats();
    const std::string name = cloud.fields[missing].name;
    cloud.fields[missing].name = "other";
    EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("field '" + name + "' is missing: the cloud has the fields "));
  }
  EXPECT_THAT([] { viewOf(pcl::PCLPointCloud2()); }, refusedWith("field 'x' is missing: the cloud has no fields"));
}

TEST(CloudView, FieldOfAnotherType)
{
  auto cloud = packedFloats();
  cloud.fields[3].datatype = Field::INT32;
  EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("field 'x' has data type 5"));
  cloud = packed<double>(Field::FLOAT64);
  cloud.fields[2].datatype = Field::FLOAT32;
  EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("field 'y' is not of the type of field 'x'"));
}

TEST(CloudView, FieldOfSeveralValues)
{
  auto cloud = packedFloats();
  cloud.fields[2].count = 2;
  EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("field 'y' holds 2 values per point"));
  cloud.fields[2].count = 0; // one, to PCL
  expectThreePoints(viewOf(cloud));
}

TEST(CloudView, FieldBeyondTheRecord)
{
  auto cloud = packedFloats();
  cloud.fields[0].offset = 10; // bytes 10 to 13 of 13
  EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("field 'z' at offset 10 reaches beyond point_step 13"));
}

TEST(CloudView, TooFewBytes)
{
  auto cloud = packedFloats();
  cloud.data.pop_back();
  EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("data holds 38 bytes: too few for 1 rows of 39 bytes"));
  cloud = packedFloats();
  cloud.height = 0xffffffff;
  EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("too few for 4294967295 rows"));
}

TEST(CloudView, PaddedRows)
{
  auto cloud = packedFloats();
  cloud.width = 1;
  cloud.height = 3;
  EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("row_step is 39 bytes, width * point_step is 13"));
  cloud.row_step = 13;
  expectThreePoints(viewOf(cloud));
}

TEST(CloudView, OneRowNeedsNoRowStep)
{
  auto cloud = packedFloats();
  cloud.row_step = 0;
  expectThreePoints(viewOf(cloud));
}

TEST(CloudView, ForeignByteOrder)
{
  auto cloud = packedFloats();
  cloud.is_bigendian = cloud.is_bigendian ? 0 : 1;
  EXPECT_THAT([&] { viewOf(cloud); }, refusedWith("is_bigendian is"));
}

TEST(CloudView, EmptyCloudAsFiltersLeaveIt)
{
  auto cloud = packedFloats();
  cloud.width = cloud.point_step = cloud.row_step = 0;
  cloud.data.clear();
  for (const unsigned height : {0u, 1u}) {
    cloud.height = height;
    EXPECT_EQ(viewOf(cloud).size(), 0u);
  }
}

TEST(CloudView, OfASharedCloudKeepsItAlive)
{
  auto typed = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>(threePoints<pcl::PointXYZ>());
  auto blob = std::make_shared<pcl::PCLPointCloud2>(packedFloats());
  const std::weak_ptr<const void> typed_alive = typed, blob_alive = blob;
  {
    const PointsView of_typed = viewOf(typed);
    const PointsView of_blob = viewOf(std::shared_ptr<const pcl::PCLPointCloud2>(blob));
    EXPECT_EQ(of_blob.count, viewOf(*blob).count);
    typed.reset();
    blob.reset();
    EXPECT_FALSE(typed_alive.expired() || blob_alive.expired());
    expectThreePoints(of_typed);
  }
  EXPECT_TRUE(typed_alive.expired() && blob_alive.expired());
  EXPECT_THROW(viewOf(typed), std::invalid_argument);
}

} // namespace
} // namespace pcl_bsh
