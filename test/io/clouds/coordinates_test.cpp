// SPDX-License-Identifier: BSD-3-Clause
// x y z that files give as integers, or in several types.
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/coordinates.h>
#include <pcl_bsh/search/cloud_view.h>

#include <gmock/gmock.h>

#include <limits>
#include <string>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;

/// intensity, x, y, z of that type and a ring, in two points.
template <typename T>
pcl::PCLPointCloud2 cloudOfType(std::uint8_t type, T least, T greatest)
{
  pcl::PCLPointCloud2 cloud;
  addField(cloud, "intensity", Field::FLOAT32);
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, type);
  addField(cloud, "ring", Field::UINT8);
  allocate(cloud, 2);
  const auto put = [&](std::size_t record, std::size_t field, auto value) {
    std::memcpy(&cloud.data[record * cloud.point_step + cloud.fields[field].offset], &value, sizeof value);
  };
  for (std::size_t i = 0; i < 2; ++i) {
    put(i, 0, 0.5F);
    put(i, 4, std::uint8_t(7));
    put(i, 2, T(i + 1));
  }
  put(0, 1, least), put(0, 3, greatest);
  put(1, 1, greatest), put(1, 3, least);
  return cloud;
}

template <typename T>
void expectReadAsFloat64(std::uint8_t type, T least, T greatest)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = cloudOfType<T>(type, least, greatest);
  for (const std::string name : {"a.pcd", "a.ply"}) {
    if (name == "a.ply" && sizeof(T) == 8) continue; // PLY has no such integers
    writeCloud(folder / name, cloud);
    const pcl::PCLPointCloud2 read = readCloud(folder / name);
    ASSERT_EQ(read.width, 2U) << name;
    EXPECT_EQ(namesOf(read), "intensity x y z ring") << name;
    const PointsView view = viewOf(read);
    EXPECT_EQ(view.point(0)[0], static_cast<double>(least)) << name;
    EXPECT_EQ(view.point(0)[2], static_cast<double>(greatest)) << name;
    EXPECT_EQ(view.point(1)[1], 2.0) << name;
    EXPECT_EQ(valueOf(read, 1, "intensity"), 0.5) << name;
    EXPECT_EQ(valueOf(read, 1, "ring"), 7) << name;
    const pcl::PCLPointCloud2 header = readCloudHeader(folder / name);
    EXPECT_EQ(header.fields[1].datatype, Field::FLOAT64) << name;
    EXPECT_EQ(header.point_step, read.point_step) << name;
    const auto stream = openCloud(folder / name, 1 << 20);
    std::vector<std::uint8_t> records(2 * stream->header().point_step);
    ASSERT_EQ(stream->read(records.data(), 2), 2U) << name;
    EXPECT_EQ(records, read.data) << name;
  }
}

TEST(Coordinates, IntegersOfAllTypesAreFloat64)
{
  expectReadAsFloat64<std::int8_t>(Field::INT8, -128, 127);
  expectReadAsFloat64<std::uint8_t>(Field::UINT8, 0, 255);
  expectReadAsFloat64<std::int16_t>(Field::INT16, -32768, 32767);
  expectReadAsFloat64<std::uint16_t>(Field::UINT16, 0, 65535);
  expectReadAsFloat64<std::int32_t>(Field::INT32, std::numeric_limits<std::int32_t>::min(), 16777217);
  expectReadAsFloat64<std::uint32_t>(Field::UINT32, 0, std::numeric_limits<std::uint32_t>::max());
  expectReadAsFloat64<std::int64_t>(Field::INT64, -9007199254740992, 9007199254740992);
  expectReadAsFloat64<std::uint64_t>(Field::UINT64, 0, 9007199254740991);
}

TEST(Coordinates, OfTextAndBinaryFilesAlike)
{
  const TemporaryFolder folder;
  const std::string pcd = "FIELDS x y z\nSIZE 2 2 2\nTYPE I I I\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ";
  const std::int16_t place[] = {-1, 2, 300};
  const std::string bytes(reinterpret_cast<const char*>(place), sizeof place);
  for (const auto& [name, text] :
       {std::pair<std::string, std::string>{"a.pcd", pcd + "ascii\n-1 2 300\n"},
        {"b.pcd", pcd + "binary\n" + bytes},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty short x\nproperty int y\n"
                  "property ushort z\nend_header\n-1 2 300\n"},
        {"b.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty int16 x\n"
                  "property int16 y\nproperty int16 z\nend_header\n" +
                      bytes}}) {
    const pcl::PCLPointCloud2 cloud = readCloud(folder.write(name, text));
    const Point3 point = viewOf(cloud).point(0);
    EXPECT_EQ(point, (Point3{-1, 2, 300})) << name;
  }
  const Mesh mesh =
      readMesh(folder.write("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n"
                                     "property uchar z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                     "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST(Coordinates, BeyondFloat64AreRefused)
{
  const TemporaryFolder folder;
  const std::string head = "FIELDS x y z\nSIZE 8 8 8\nTYPE I I I\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n";
  EXPECT_THAT([&] { readCloud(folder.write("a.pcd", head + "1 9007199254740994 3\n")); },
              testing::ThrowsMessage<files::FileError>(HasSubstr(
                  "has 9007199254740994 in 'y', which float64 does not hold: export it with coordinates below 2^53")));
  for (const std::string far : {"9007199254740993", "-9007199254740993", "9223372036854775807"})
    EXPECT_THROW(readCloud(folder.write("a.pcd", head + "1 2 " + far + "\n")), files::FileError) << far;
  const std::string none = "FIELDS x y\nSIZE 4 4\nTYPE I I\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2\n";
  EXPECT_THROW(readCloud(folder.write("b.pcd", none)), files::FileError);
}

} // namespace
} // namespace pcl_bsh::io
