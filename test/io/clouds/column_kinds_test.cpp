// SPDX-License-Identifier: BSD-3-Clause
// Columns that float64 does not hold are written again as they were read.
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/lines/column_kinds.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>

#include <gmock/gmock.h>

#include <sstream>
#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;

std::string writtenAgain(const std::string& file, char separator = ',')
{
  std::ostringstream out;
  writeColumns(out, parseColumns(file), separator);
  return out.str();
}

std::uint8_t typeOf(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  for (const Field& field : cloud.fields)
    if (field.name == name) return field.datatype;
  throw std::invalid_argument("no field " + name);
}

TEST(ColumnKinds, TimeStampsStayAsTheyAre)
{
  for (const std::string file :
       {"t,x,y,z\n1403636579763555585,1,2,3\n1403636579813555456,4,5,6\n",         // nanoseconds of EuRoC
        "x,y,z,stamp\n1,2,3,1403636579763555584\n4,5,6,1403636579763555587\n",     // the first is a float64, too
        "x,y,z,stamp\n1,2,3,18446744073709551615\n4,5,6,9007199254740993\n",       // 64 bits without a sign
        "x,y,z,stamp\n1,2,3,-9223372036854775808\n4,5,6,0\n",                      // with one
        "x,y,z,stamp\n1,2,3,1403636579.763555584\n4,5,6,1403636579.813555456\n",   // seconds
        "x,y,z,stamp\n1,2,3,123456789012345678901\n4,5,6,123456789012345678902\n", // more than 64 bits
        "x,y,z,stamp\n1,2,3,1403636579763555585\n4,5,6,\n",                        // one is not known
        "x,y,z,stamp\n1,2,3,00000001403636579763555585\n4,5,6,7.5\n"}) {
    EXPECT_EQ(writtenAgain(file), file);
    EXPECT_EQ(namesOf(parseColumnNames(file)), namesOf(parseColumns(file))) << file;
  }
  const pcl::PCLPointCloud2 cloud = parseColumns("t x y z u\n1403636579763555585 1 2 3 18446744073709551615\n");
  EXPECT_EQ(typeOf(cloud, "t"), Field::INT64);
  EXPECT_EQ(typeOf(cloud, "u"), Field::UINT64);
  EXPECT_EQ(valueOf(cloud, 0, "z"), 3);
}

TEST(ColumnKinds, NumbersThatFloat64HoldsStayNumbers)
{
  for (const char* word :
       {"1", "-1.5e300", "0.1", "0.10000000000000001", "0.1000000000000000055511151231257827", "0.10000000149011611938",
        "9007199254740992", "1403636579763555584", "1e400", "1e-400", "nan", "-1.#IND", "000000000000000000000012",
        "596648.12345678910", "3.141592653589793116", "0", "1.000000000000000000000"})
    EXPECT_TRUE(float64Holds(word)) << word;
  for (const char* word : {"1403636579.763555584", "0.12345678901234567890", "1403636579763555585",
                           "1.00000000000000001", "-9007199254740993", "123456789.123456789123e5"})
    EXPECT_FALSE(float64Holds(word)) << word;
  const pcl::PCLPointCloud2 cloud = parseColumns("x y z i q w\n1 2 3 0.1000000000000000055511151231257827 7 12\n");
  for (const Field& field : cloud.fields) EXPECT_EQ(field.datatype, Field::FLOAT64) << field.name;
  const pcl::PCLPointCloud2 far = parseColumns("x y z\n596648.12345678901234567 9007199254740993 3\n");
  for (const Field& field : far.fields) EXPECT_EQ(field.datatype, Field::FLOAT64) << "coordinates are";
}

TEST(ColumnKinds, NamesAndCodesStayAsTheyAre)
{
  for (const std::string file :
       {"name,x,y,z\nP1,1,2,3\nP2,4,5,6\n", "x,y,z,code,i\n1,2,3,TREE oak,7\n4,5,6,,8\n",
        "x,y,z,a,b\n1,2,3,A,#7x\n4,5,6,12,B\n", "x,y,z,time\n1,2,3,12:30:45.123\n4,5,6,2024-05-06T07:08:09Z\n",
        "x,y,z,s\n1,2,3,\xc3\xa9t\xc3\xa9\n4,5,6,n/a\n"}) {
    if (file.find('#') == std::string::npos)
      EXPECT_EQ(writtenAgain(file), file);
    else
      EXPECT_EQ(defectOf([&] { writtenAgain(file); }),
                "field 'b' has the text '#7x', which cannot stand between separators");
  }
  std::vector<std::string> remarks;
  const pcl::PCLPointCloud2 cloud = parseColumns("P1 1 2 3\nlonger 4 5 6\n", {"name", "x", "y", "z"}, &remarks);
  EXPECT_EQ(namesOf(cloud), "name x y z");
  EXPECT_EQ(cloud.fields[0].datatype, Field::INT8);
  EXPECT_EQ(cloud.fields[0].count, 7U) << "and a zero";
  EXPECT_EQ(textOf(cloud.fields[0], reinterpret_cast<const char*>(cloud.data.data())), "P1");
  EXPECT_EQ(textOf(cloud.fields[0], reinterpret_cast<const char*>(&cloud.data[cloud.point_step])), "longer");
  EXPECT_THAT(remarks, testing::ElementsAre("column 'name' holds no numbers alone ('P1'), and is kept as text"));
  EXPECT_EQ(writtenAgain("1 2 3 oak\n4 5 6 elm\n", ' '), "x y z column_4\n1 2 3 oak\n4 5 6 elm\n");
  EXPECT_EQ(writtenAgain("1;2;3;\"oak\";1.#QNAN\n4;5;6;\"\";7\n"),
            "x,y,z,column_4,column_5\n1,2,3,oak,nan\n4,5,6,,7\n");
  EXPECT_EQ(defectOf([] { writtenAgain("1;2;3;oak tree\n", ' '); }),
            "field 'column_4' has the text 'oak tree', which cannot stand between separators");
}

TEST(ColumnKinds, GoThroughPcdAndPly)
{
  const TemporaryFolder folder;
  const std::string file = "x,y,z,name,stamp\n1,2,3,P1,1403636579763555585\n4,5,6,,1403636579763555587\n";
  const pcl::PCLPointCloud2 cloud = readCloud(folder.write("a.csv", file));
  EXPECT_EQ(readCloudHeader(folder / "a.csv").point_step, cloud.point_step);
  writeCloud(folder / "b.pcd", cloud);
  writeCloud(folder / "c.csv", readCloud(folder / "b.pcd"));
  EXPECT_EQ(contentOf(folder / "c.csv"), file);
  const pcl::PCLPointCloud2 named = parseColumns("x,y,z,name\n1,2,3,P1\n4,5,6,P22\n");
  writeCloud(folder / "d.ply", named);
  writeCloud(folder / "e.csv", readCloud(folder / "d.ply"));
  EXPECT_EQ(contentOf(folder / "e.csv"), "x,y,z,name\n1,2,3,P1\n4,5,6,P22\n");
}

TEST(ColumnKinds, WhatIsNoTextIsRefused)
{
  EXPECT_THAT(defectOf([] { parseColumns("1;2;3;0,5\n"); }), HasSubstr("'0,5' is not a number")) << "a decimal comma";
  EXPECT_THAT(defectOf([] { parseColumns(std::string("1 2 3 a\1\n")); }), HasSubstr("is not a number"));
  EXPECT_THAT(defectOf([] { parseColumns("P1 2 3 4\n"); }), HasSubstr("'P1' is not a number")) << "a coordinate";
  std::string rows;
  for (int i = 0; i < 1200; ++i) rows += "1 2 3 4\n";
  EXPECT_THAT(defectOf([&] { parseColumns(rows + "1 2 3 tree\n"); }),
              HasSubstr("line 1201 is damaged: 'tree' is not a number"));
  EXPECT_EQ(parseColumns(rows + "1 2 3 tree\n", {"x", "y", "z", "_"}).width, 1201U);
  pcl::PCLPointCloud2 histogram;
  for (const char* axis : {"x", "y", "z"}) addField(histogram, axis, Field::FLOAT32);
  addField(histogram, "h", Field::INT8, 3);
  allocate(histogram, 1);
  for (std::size_t k = 0; k < 3; ++k) histogram.data[12 + k] = 65;
  std::ostringstream out;
  EXPECT_EQ(defectOf([&] { writeColumns(out, histogram); }), "field 'h' has 3 values per point");
}

/// Memory follows the file: a single long word does not widen a million rows.
TEST(ColumnKinds, TakeNoMoreThanTheFileJustifies)
{
  std::string rows = "1 2 3 " + std::string(20'000, 'a') + '\n';
  EXPECT_EQ(parseColumns(rows).fields[3].count, 20'001U);
  for (int i = 0; i < 500; ++i) rows += "1 2 3 b\n";
  EXPECT_THAT(defectOf([&] { parseColumns(rows); }), HasSubstr("much longer than others"));
  std::string alike;
  for (int i = 0; i < 500; ++i) alike += "1 2 3 " + std::string(500, 'a') + '\n';
  EXPECT_EQ(parseColumns(alike).width, 500U);
}

TEST(ColumnKinds, ABeginningTellsWhereItIsLongEnough)
{
  std::string rows;
  while (rows.size() < 70'000) rows += "1 2 3 1403636579763555585\n";
  EXPECT_EQ(typeOf(parseColumnNames(rows, false), "column_4"), Field::INT64);
  EXPECT_THAT(defectOf([] { parseColumnNames("1 2 3 4\n1 2 3 4\n", false); }), HasSubstr("is known in part"));
  EXPECT_EQ(parseColumnNames("1 2 3\n4 5 6\n", false).fields.size(), 3U) << "coordinates are float64, whatever follows";
}

} // namespace
} // namespace pcl_bsh::io
