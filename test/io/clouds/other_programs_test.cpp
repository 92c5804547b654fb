// SPDX-License-Identifier: BSD-3-Clause
// Files pass between this library and others with the same points, colours and normals: PCL's readers and writers, and
// files as MeshLab and CloudCompare lay them out.
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <pcl/conversions.h>
#include <pcl/io/obj_io.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::io {

namespace {

using PclPoint = pcl::PointXYZRGBNormal;
using PclCloud = pcl::PointCloud<PclPoint>;

PclCloud samples(std::uint32_t width = 40, std::uint32_t height = 1)
{
  PclCloud cloud(width, height);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    PclPoint& p = cloud[i];
    const auto k = static_cast<float>(i);
    p.getVector3fMap() = Eigen::Vector3f(k / 3, -k, 1e-3F * k * k);
    p.getNormalVector3fMap() = Eigen::Vector3f(std::sin(k), std::cos(k), 0);
    p.curvature = k / 7;
    p.r = static_cast<std::uint8_t>(255 - i);
    p.g = static_cast<std::uint8_t>(i);
    p.b = static_cast<std::uint8_t>(7 * i % 256);
  }
  return cloud;
}

void expectAlike(const PclCloud& actual, const PclCloud& expected, const std::string& what, float tolerance = 0)
{
  ASSERT_EQ(actual.size(), expected.size()) << what;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const PclPoint &a = actual[i], &b = expected[i];
    EXPECT_LE((a.getVector3fMap() - b.getVector3fMap()).norm(), tolerance) << what << ' ' << i;
    EXPECT_LE((a.getNormalVector3fMap() - b.getNormalVector3fMap()).norm(), tolerance) << what << ' ' << i;
    EXPECT_EQ(a.getRGBVector3i(), b.getRGBVector3i()) << what << ' ' << i;
  }
}

PclCloud typed(const pcl::PCLPointCloud2& cloud)
{
  PclCloud points;
  pcl::fromPCLPointCloud2(cloud, points);
  return points;
}

class OtherPrograms : public testing::Test {
protected:
  OtherPrograms() { pcl::toPCLPointCloud2(points, cloud); }

  TemporaryFolder folder;
  PclCloud points = samples();
  pcl::PCLPointCloud2 cloud;
};

TEST_F(OtherPrograms, PclReadsWhatIsWritten)
{
  writeCloud(folder / "a.ply", cloud, {1, 2, 3, 0.5F, 0.5F, 0.5F, 0.5F});
  writeCloud(folder / "a.pcd", cloud);
  PclCloud read;
  ASSERT_EQ(pcl::io::loadPLYFile((folder / "a.ply").string(), read), 0);
  expectAlike(read, points, "PLY");
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "a.pcd").string(), read), 0);
  expectAlike(read, points, "PCD");
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i].curvature, points[i].curvature);
}

TEST_F(OtherPrograms, WhatPclWritesIsRead)
{
  pcl::PLYWriter ply;
  ASSERT_EQ(ply.write((folder / "ascii.ply").string(), points, false, true), 0);
  ASSERT_EQ(ply.write((folder / "binary.ply").string(), points, true, true), 0);
  ASSERT_EQ(ply.write((folder / "grid.ply").string(), points, true, false), 0);
  pcl::io::savePCDFileASCII((folder / "ascii.pcd").string(), points);
  pcl::io::savePCDFileBinary((folder / "binary.pcd").string(), points);
  pcl::io::savePCDFileBinaryCompressed((folder / "compressed.pcd").string(), points);
  for (const std::string name : {"ascii.ply", "binary.ply", "grid.ply", "ascii.pcd", "binary.pcd", "compressed.pcd"}) {
    const pcl::PCLPointCloud2 read = readCloud(folder / name);
    expectAlike(typed(read), points, name, name.starts_with("ascii") ? 1e-4F : 0);
    EXPECT_EQ(namesOf(read), namesOf(name.ends_with("ply") ? cloud : read)) << name;
  }
}

TEST_F(OtherPrograms, OpacityPassesBothWays)
{
  pcl::PointCloud<pcl::PointXYZRGBA> transparent(30, 1);
  for (std::size_t i = 0; i < 30; ++i) transparent[i].rgba = static_cast<std::uint32_t>(0x01020304U * i);
  ASSERT_EQ(pcl::PLYWriter().write((folder / "a.ply").string(), transparent, true, true), 0);
  const pcl::PCLPointCloud2 read = readCloud(folder / "a.ply");
  writeCloud(folder / "b.ply", read);
  pcl::PointCloud<pcl::PointXYZRGBA> again;
  ASSERT_EQ(pcl::io::loadPLYFile((folder / "b.ply").string(), again), 0);
  ASSERT_EQ(again.size(), 30U);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(colourOf(read, i, "rgba"), transparent[i].rgba) << i;
    EXPECT_EQ(again[i].rgba, transparent[i].rgba) << i;
  }
}

TEST_F(OtherPrograms, PclReadsObjAsItIsRead)
{
  pcl::PCLPointCloud2 vertices = cloud;
  vertices.fields.erase(std::remove_if(vertices.fields.begin(), vertices.fields.end(),
                                       [](const Field& field) { return field.name == "curvature"; }),
                        vertices.fields.end());
  writeCloud(folder / "a.obj", vertices);
  pcl::PCLPointCloud2 read;
  ASSERT_EQ(pcl::OBJReader().read((folder / "a.obj").string(), read), 0);
  ASSERT_EQ(read.width * read.height, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(valueOf(read, i, "x"), points[i].x) << i;
    EXPECT_EQ(valueOf(read, i, "normal_y"), points[i].normal_y) << i;
  }
}

/// A value's bytes in the byte order asked for.
template <typename T>
std::string bytes(T value, bool big)
{
  std::string text(reinterpret_cast<const char*>(&value), sizeof value);
  if (big) std::reverse(text.begin(), text.end());
  return text;
}

TEST_F(OtherPrograms, MeshLabsLayout)
{
  const std::string head =
      "comment VCGLIB generated\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
      "property float quality\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto binary = [&](bool big) {
    std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + head;
    for (const float k : {1.0F, 2.0F}) {
      for (const float value : {k, 0.1F, -k, 0.0F, 0.6F, 0.8F}) file += bytes(value, big);
      file += std::string("\xc8\x64\x32", 3) + static_cast<char>(k) + bytes(k / 4, big);
    }
    return file + "\x01" + bytes<std::int32_t>(0, big);
  };
  folder.write("little.ply", binary(false));
  folder.write("big.ply", binary(true));
  folder.write("ascii.ply", "ply\nformat ascii 1.0\n" + head +
                                "1 0.1 -1 0 0.6 0.8 200 100 50 1 0.25 \n2 0.1 -2 0 0.6 0.8 200 100 50 2 0.5 \n1 0 \n");
  for (const char* name : {"little.ply", "big.ply", "ascii.ply"}) {
    const pcl::PCLPointCloud2 read = readCloud(folder / name);
    EXPECT_EQ(namesOf(read), "x y z normal_x normal_y normal_z rgba quality") << name;
    ASSERT_EQ(read.width, 2U) << name;
    for (std::size_t i = 0; i < 2; ++i) {
      const float k = static_cast<float>(i + 1);
      EXPECT_EQ(valueOf(read, i, "x"), k) << name;
      EXPECT_EQ(valueOf(read, i, "y"), 0.1F) << name;
      EXPECT_EQ(valueOf(read, i, "normal_z"), 0.8F) << name;
      EXPECT_EQ(valueOf(read, i, "quality"), k / 4) << name;
      EXPECT_EQ(colourOf(read, i, "rgba"), 0xc86432U | static_cast<std::uint32_t>(i + 1) << 24) << name;
    }
  }
  const pcl::PCLPointCloud2 mesh = readCloud(folder.write(
      "a.obj",
      "####\n#\n# OBJ File Generated by Meshlab\n#\n####\n# Object a.obj\n#\n# Vertices: 2\n# Faces: 0\n#\n####\n"
      "vn 0.000000 0.600000 0.800000\nv 1.000000 0.100000 -1.000000 0.784314 0.392157 0.196078\n"
      "vn 0.000000 0.600000 0.800000\nv 2.000000 0.100000 -2.000000 0.784314 0.392157 0.196078\n"
      "# 2 vertices, 0 vertices normals\n\n# 0 faces, 0 coords texture\n\n# End of File\n"));
  EXPECT_EQ(colourOf(mesh, 1), 0xc86432U);
  EXPECT_EQ(valueOf(mesh, 1, "normal_z"), 0.8);
}

TEST_F(OtherPrograms, CloudComparesLayout)
{
  const std::string head = "comment Created by CloudCompare v2.12\nobj_info Generated by CloudCompare!\n"
                           "element vertex 1\nproperty double x\nproperty double y\nproperty double z\n"
                           "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float nx\n"
                           "property float ny\nproperty float nz\nproperty float scalar_Intensity\nend_header\n";
  const std::string row = bytes(596648.125, false) + bytes(243620.5, false) + bytes(7.25, false) + "\xc8\x64\x32" +
                          bytes(0.0F, false) + bytes(0.6F, false) + bytes(0.8F, false) + bytes(42.0F, false);
  folder.write("a.ply", "ply\nformat binary_little_endian 1.0\n" + head + row);
  const std::string values =
      "596648.12500000 243620.50000000 7.25000000 200 100 50 42.000000 0.000000 0.600000 0.800000";
  folder.write("a.txt", "//X Y Z R G B scalar_Intensity Nx Ny Nz\n" + values + "\n");
  std::string commas = values;
  std::replace(commas.begin(), commas.end(), ' ', ',');
  folder.write("a.xyz", "//X,Y,Z,R,G,B,scalar_Intensity,Nx,Ny,Nz\n" + commas + "\n");
  for (const char* name : {"a.ply", "a.txt", "a.xyz"}) {
    const pcl::PCLPointCloud2 read = readCloud(folder / name);
    ASSERT_EQ(read.width, 1U) << name;
    EXPECT_EQ(valueOf(read, 0, "x"), 596648.125) << name;
    EXPECT_EQ(valueOf(read, 0, "z"), 7.25) << name;
    EXPECT_EQ(colourOf(read, 0), 0xc86432U) << name;
    EXPECT_NEAR(valueOf(read, 0, "normal_z"), 0.8, 1e-7) << name;
    EXPECT_EQ(valueOf(read, 0, "scalar_Intensity"), 42) << name;
  }
}

} // namespace
} // namespace pcl_bsh::io
