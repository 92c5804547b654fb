// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/filters/io/text_clouds.h>

#include <sstream>

namespace pcl_bsh::io {

TEST(TextClouds, ColumnsAreFloat64)
{
  const pcl::PCLPointCloud2 cloud = parseColumns("# scan 7\n//X Y Z\n596648.1234567891 2 3\n\n4\t5 6 # last\n");
  ASSERT_EQ(cloud.width, 2U);
  EXPECT_EQ(cloud.fields.size(), 3U);
  EXPECT_EQ(cloud.fields[0].datatype, Field::FLOAT64);
  EXPECT_EQ(valueOf(cloud, 0, "x"), 596648.1234567891);
  EXPECT_EQ(valueOf(cloud, 1, "z"), 6);
}

TEST(TextClouds, MoreColumnsAreKept)
{
  const pcl::PCLPointCloud2 cloud = parseColumns("1,2,3,40,50\n6;7;8;nan;100\n");
  ASSERT_EQ(cloud.fields.size(), 5U);
  EXPECT_EQ(valueOf(cloud, 0, "column_4"), 40);
  EXPECT_EQ(valueOf(cloud, 1, "column_5"), 100);
}

TEST(TextClouds, AFirstLineMayNameTheColumns)
{
  const pcl::PCLPointCloud2 cloud = parseColumns("intensity,x,y,z\n9,1,2,3\n");
  EXPECT_EQ(valueOf(cloud, 0, "x"), 1);
  EXPECT_EQ(valueOf(cloud, 0, "intensity"), 9);
  EXPECT_EQ(parseColumns("nan nan nan\n").width, 1U) << "a point, not names";
}

TEST(TextClouds, RefusesDamagedColumns)
{
  EXPECT_EQ(defectOf([] { parseColumns("# nothing\n"); }), "holds no points");
  EXPECT_EQ(defectOf([] { parseColumns("x y z\n"); }), "holds no points");
  EXPECT_EQ(defectOf([] { parseColumns("1 2\n"); }), "line 1 is no point: it has fewer than three numbers");
  EXPECT_EQ(defectOf([] { parseColumns("1 2 3\n4 5\n"); }), "line 2 has fewer values than it should");
  EXPECT_EQ(defectOf([] { parseColumns("1 2 3\n4 5 6 7\n"); }), "line 2 has more values than it should, from '7' on");
  EXPECT_EQ(defectOf([] { parseColumns("1 2 3\n4 five 6\n"); }), "line 2 is damaged: 'five' is not a number");
}

TEST(TextClouds, ObjVertices)
{
  const pcl::PCLPointCloud2 cloud =
      parseObj("# cube\no cube\nv 1 2 3\nvn 0 0 1\nvt 0 0\n  v 0.1 5 6 0.5 0.5 0.5\nf 1 2 1\n");
  ASSERT_EQ(cloud.width, 2U);
  EXPECT_EQ(valueOf(cloud, 1, "x"), 0.1);
  EXPECT_EQ(defectOf([] { parseObj("o nothing\n"); }), "has no vertices");
  EXPECT_EQ(defectOf([] { parseObj("v 1 2\n"); }), "line 1 has fewer values than it should");
}

TEST(TextClouds, OffVertices)
{
  const pcl::PCLPointCloud2 cloud = parseOff("OFF # a triangle\n3 1 0\n\n0.1 2 3\n4 5 6\n7 8 9\n3 0 1 2\n");
  ASSERT_EQ(cloud.width, 3U);
  EXPECT_EQ(valueOf(cloud, 0, "x"), 0.1);
  EXPECT_EQ(parseOff("COFF 1 0 0\n1 2 3 255 0 0 255\n").width, 1U);
  EXPECT_EQ(parseOff("OFF 0 0 0\n").width, 0U);
}

TEST(TextClouds, RefusesDamagedOff)
{
  EXPECT_EQ(defectOf([] { parseOff("4OFF\n1 0 0\n1 2 3 4\n"); }), "is not an OFF file: it does not start with 'OFF'");
  EXPECT_EQ(defectOf([] { parseOff("OFF BINARY\n"); }), "is a binary OFF file");
  EXPECT_EQ(defectOf([] { parseOff("OFF\n"); }), "is truncated: it has no counts");
  EXPECT_EQ(defectOf([] { parseOff("OFF\n2000000000 0 0\n1 2 3\n"); }),
            "is truncated: its header promises 2000000000 points, its size allows 1 at most");
  EXPECT_EQ(defectOf([] { parseOff("OFF\n2 0 0\n1.125 2.125 3.125\n"); }),
            "is truncated: it ends before the last of its vertices");
  EXPECT_EQ(defectOf([] { parseOff("OFF\n1 2 0\n1 2 3\n3 0 0 0\n"); }),
            "is truncated: it ends before the last of its faces");
  EXPECT_EQ(defectOf([] { parseOff("OFF\n3000000000 0 0\n"); }),
            "it has 3000000000 points, more than the 2147483647 that an index can name");
}

TEST(TextClouds, WritesColumnsThatReadBackAsTheyWere)
{
  const std::string text = "x y z label\n596648.1234567891 -2 1e-300 7\nnan 0.1 3 8\n";
  std::ostringstream out;
  writeColumns(out, parseColumns(text));
  EXPECT_EQ(out.str(), text);
}

TEST(TextClouds, WritesEachTypeInItsOwnDigits)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, Field::FLOAT32);
  addField(cloud, "ring", Field::UINT8);
  allocate(cloud, 1);
  const float coordinates[] = {0.1F, 16777216, -1};
  std::memcpy(cloud.data.data(), coordinates, sizeof coordinates);
  cloud.data.back() = 200;
  std::ostringstream out;
  writeColumns(out, cloud);
  EXPECT_EQ(out.str(), "x y z ring\n0.1 16777216 -1 200\n");
}

TEST(TextClouds, WritesVertices)
{
  std::ostringstream out;
  writeObj(out, parseColumns("z y x\n3 2 1\n6 5 4\n"));
  EXPECT_EQ(out.str(), "v 1 2 3\nv 4 5 6\n");
}

TEST(TextClouds, RefusesFieldsThatTextCannotHold)
{
  std::ostringstream out;
  EXPECT_EQ(defectOf([&] { writeColumns(out, randomCloud<float>(1, 1, {})); }),
            "field 'histogram' has 5 values per point");
  pcl::PCLPointCloud2 cloud = parseColumns("1 2 3 4\n");
  EXPECT_EQ(defectOf([&] { writeObj(out, cloud); }), "field 'column_4' has no place in an .obj");
  cloud.fields.back().name = "4";
  EXPECT_EQ(defectOf([&] { writeColumns(out, cloud); }), "field '4' cannot name a column");
}

TEST(TextClouds, HeaderNamesTheColumns)
{
  EXPECT_EQ(parseColumnNames("1 2 3 4\n5 six\n").fields.back().name, "column_4");
  EXPECT_EQ(parseColumnNames("x y z ring\n").fields.size(), 4U);
}

} // namespace pcl_bsh::io
