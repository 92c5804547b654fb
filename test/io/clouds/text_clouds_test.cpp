// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>

#include <gmock/gmock.h>

#include <sstream>

namespace pcl_bsh::io {

using ::testing::HasSubstr;

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
  const pcl::PCLPointCloud2 cloud = parseColumns("1,2,3,40,50\n6, 7,\t8,nan , 100\n");
  ASSERT_EQ(cloud.fields.size(), 5U);
  EXPECT_EQ(valueOf(cloud, 0, "column_4"), 40);
  EXPECT_EQ(valueOf(cloud, 1, "column_5"), 100);
}

TEST(TextClouds, TakesAsLongAsTheTextIsWhateverItsColumns)
{
  constexpr std::size_t columns = 400'000; // with a step for each pair of columns, hours
  std::string row = "1,2,3", names = "a0,a1,x,y,z";
  for (std::size_t i = 4; i <= columns; ++i) row += ",7";
  for (std::size_t i = 6; i <= columns; ++i) names += ",a" + std::to_string(i);
  EXPECT_EQ(parseColumns(row).fields.size(), columns);
  const pcl::PCLPointCloud2 named = parseColumns(names + '\n' + row + '\n' + row);
  EXPECT_EQ(named.fields.size(), columns);
  EXPECT_EQ(valueOf(named, 1, "z"), 7);
  EXPECT_EQ(columnNamesOf(names).size(), columns);
}

TEST(TextClouds, AFirstLineMayNameTheColumns)
{
  const pcl::PCLPointCloud2 cloud = parseColumns("intensity,x,y,z\n9,1,2,3\n");
  EXPECT_EQ(valueOf(cloud, 0, "x"), 1);
  EXPECT_EQ(valueOf(cloud, 0, "intensity"), 9);
  EXPECT_EQ(parseColumns("nan nan nan\n").width, 1U) << "a point, not names";
}

TEST(TextClouds, TheFirstRowDecidesTheSeparator)
{
  for (const std::string rows :
       {"1.5;2;3\n4;5;6\n", "1.5,2,3,\n4,5,6\n", "1.5\t2\t3\n4\t5 \t 6\n", "1.5 2\t3\n4 5 6\n"}) {
    const pcl::PCLPointCloud2 cloud = parseColumns(rows);
    ASSERT_EQ(cloud.width, 2U) << rows;
    EXPECT_EQ(valueOf(cloud, 0, "x"), 1.5) << rows;
    EXPECT_EQ(valueOf(cloud, 1, "z"), 6) << rows;
  }
  const pcl::PCLPointCloud2 named = parseColumns("x y z\n1;2;3\n");
  EXPECT_EQ(valueOf(named, 0, "z"), 3) << "the names' line may have its own";
}

TEST(TextClouds, TakesWhatProgramsWriteForNaNAsNaN)
{
  for (const std::string nan : {"1.#QNAN", "-1.#IND", "1.#SNAN", "-1.#IND00", "nan(ind)", "NaN"}) {
    const pcl::PCLPointCloud2 points = parseColumns("1 2 3\n5 6 " + nan + "\n7 8 9 # seen\n");
    ASSERT_EQ(points.width, 3U) << nan;
    EXPECT_EQ(valueOf(points, 1, "y"), 6) << nan;
    EXPECT_TRUE(std::isnan(valueOf(points, 1, "z"))) << nan;
    EXPECT_EQ(valueOf(points, 2, "z"), 9) << nan;
    const pcl::PCLPointCloud2 named = parseColumns("x;i;y;z\n" + nan + ";" + nan + ";2;3\n");
    EXPECT_TRUE(std::isnan(valueOf(named, 0, "x")) && std::isnan(valueOf(named, 0, "i"))) << nan;
    EXPECT_TRUE(std::isnan(valueOf(parseColumns(nan + " 1 2\n"), 0, "x"))) << nan << " is a point, not names";
    EXPECT_TRUE(std::isnan(valueOf(parseObj("v 1 2 3\nv 1 2 " + nan + "\nf 1 1 1\n"), 1, "z"))) << nan;
    EXPECT_TRUE(std::isnan(valueOf(parseOff("OFF\n1 0 0\n1 " + nan + " 3\n"), 0, "y"))) << nan;
    const pcl::PCLPointCloud2 coloured = parseObj("v 1 2 3 0.2 0.4 " + nan + "\n");
    EXPECT_EQ(namesOf(coloured), "x y z red green blue") << nan << " is no share of 1";
    EXPECT_TRUE(std::isnan(valueOf(coloured, 0, "blue"))) << nan;
  }
  EXPECT_EQ(valueOf(parseColumns("1 2 -1.#INF\n"), 0, "z"), -std::numeric_limits<double>::infinity());
  EXPECT_THAT(defectOf([] { parseColumns("1 2 3#note\n"); }), HasSubstr("'3#note' is not a number"));
}

TEST(TextClouds, TakesAnEmptyValueForNaN)
{
  for (const char* rows :
       {"x,y,z,i,t\n1,2,3,,5\n1,2,3,4,\n1,2,3,4,5\n", "x;y;z;i;t\n1;2;3;;5\n1;2;3;\"4\";\"\"\n1;2;3;4;5\n"}) {
    const pcl::PCLPointCloud2 cloud = parseColumns(rows);
    ASSERT_EQ(cloud.width, 3U) << rows;
    EXPECT_TRUE(std::isnan(valueOf(cloud, 0, "i"))) << rows;
    EXPECT_EQ(valueOf(cloud, 0, "t"), 5) << rows;
    EXPECT_EQ(valueOf(cloud, 1, "i"), 4) << rows;
    EXPECT_TRUE(std::isnan(valueOf(cloud, 1, "t"))) << rows;
    EXPECT_EQ(valueOf(cloud, 2, "t"), 5) << rows;
  }
  const pcl::PCLPointCloud2 coloured = parseColumns("x,y,z,red,green,blue\n1,2,3,4,5,\n1,2,3,4,5,6\n");
  EXPECT_TRUE(std::isnan(valueOf(coloured, 0, "blue"))) << "so the channels are no colour";
  EXPECT_EQ(valueOf(coloured, 1, "blue"), 6);
  EXPECT_EQ(defectOf([] { parseColumns("x,y,z,i,t\n1,2,3,4\n"); }), "line 2 has fewer values than it should");
  for (const char* row : {",2,3,4\n", "1,,3,4\n", "1,2,,4\n"})
    EXPECT_EQ(defectOf([row] { parseColumns(std::string("X,Y,Z,i\n1,2,3,4\n") + row); }), "line 3 has an empty value");
  EXPECT_EQ(defectOf([] { parseColumns("i,x,y,z\n,1,2,\n"); }), "line 2 has fewer values than it should");
}

TEST(TextClouds, RefusesDecimalCommasAndMixedSeparators)
{
  EXPECT_EQ(defectOf([] { parseColumns("1,5;2,5;3,5\n"); }), "line 1 is damaged: '1,5' is not a number");
  EXPECT_EQ(defectOf([] { parseColumns("1,5 2,5 3,5\n"); }), "line 1 is damaged: '5 2' is not a number");
  EXPECT_EQ(defectOf([] { parseColumns("x\ty\tz\n1,5\t2,5\t3,5\n"); }), "line 2 is damaged: '5\t2' is not a number");
  EXPECT_EQ(defectOf([] { parseColumns("1;2;3\n4,5,6\n"); }), "line 2 is damaged: '4,5,6' is not a number");
  EXPECT_EQ(defectOf([] { parseColumns("1 2 3\n4,5 5,5 6,5\n"); }), "line 2 is damaged: '4,5' is not a number");
  EXPECT_EQ(defectOf([] { parseColumns("1\t2\t3\n4 5 6\n"); }), "line 2 is damaged: '4 5 6' is not a number");
  EXPECT_EQ(defectOf([] { parseColumns("x,y,z,i\n1,2,,3\n"); }), "line 2 has an empty value");
  EXPECT_EQ(defectOf([] { parseColumns("x\ty\tz\ti\n1\t2\t\t3\n"); }), "line 2 has an empty value");
  try {
    parseColumns("1,5;2,5;3,5\n");
    ADD_FAILURE() << "was read";
  }
  catch (const FormatError& error) {
    EXPECT_EQ(error.remedy(), "write a decimal point, and one separator in all lines");
  }
}

TEST(TextClouds, CommentsMayNameTheColumns)
{
  const pcl::PCLPointCloud2 cloud =
      parseColumns("//X,Y,Z,R,G,B,Nx,Ny,Nz\n1,2,3,200,100,50,0,0.6,0.8\n4,5,6,1,2,3,1,0,0\n");
  EXPECT_EQ(namesOf(cloud), "x y z rgb normal_x normal_y normal_z");
  EXPECT_EQ(colourOf(cloud, 0), 0xc86432U);
  EXPECT_EQ(colourOf(cloud, 1), 0x010203U);
  EXPECT_EQ(valueOf(cloud, 0, "normal_z"), 0.8);
  EXPECT_EQ(namesOf(parseColumns("// made by hand\n//X Y Z R G B A\n1 2 3 4 5 6 7\n")), "x y z rgba");
  EXPECT_EQ(namesOf(parseColumns("# x y z intensity\n1 2 3 4\n")), "x y z intensity");
  EXPECT_EQ(namesOf(parseColumns("// z y x Intensity\n1 2 3 4\n")), "z y x intensity");
  EXPECT_EQ(namesOf(parseColumns("// x y z in metres\n1 2 3\n")), "x y z") << "another number of words: no names";
  EXPECT_EQ(namesOf(parseColumns("X;Y;Z;Scan Angle;INTENSITY\n1;2;3;4;5\n")), "x y z Scan_Angle intensity");
}

TEST(TextClouds, OnlyBytesAreColours)
{
  for (const char* odd : {"256", "0.5", "-1", "1e3"}) {
    const std::string file = "x y z r g b\n1 2 3 255 0 0\n1 2 3 0 " + std::string(odd) + " 0\n";
    const pcl::PCLPointCloud2 cloud = parseColumns(file);
    EXPECT_EQ(namesOf(cloud), "x y z r g b") << odd;
    EXPECT_EQ(cloud.fields[3].datatype, Field::FLOAT64) << odd;
    EXPECT_EQ(valueOf(cloud, 0, "r"), 255) << odd;
    EXPECT_EQ(namesOf(parseColumnNames(file)), "x y z r g b") << odd;
  }
  const pcl::PCLPointCloud2 cloud = parseColumns("x y z red green blue ring\n1 2 3 4 5 6 7\n");
  EXPECT_EQ(namesOf(cloud), "x y z rgb ring");
  EXPECT_EQ(cloud.fields[4].datatype, Field::FLOAT64) << "as all columns but colours";
}

TEST(TextClouds, NamesThatAreGivenHoldInPlaceOfTheFiles)
{
  const pcl::PCLPointCloud2 numbered = parseColumns("1 10 20 30 7\n2 11 21 31 8\n", {"_", "E", "N", "h", "intensity"});
  EXPECT_EQ(namesOf(numbered), "x y z intensity");
  EXPECT_EQ(valueOf(numbered, 1, "x"), 11);
  EXPECT_EQ(valueOf(numbered, 1, "z"), 31);
  EXPECT_EQ(valueOf(numbered, 1, "intensity"), 8);
  const pcl::PCLPointCloud2 headed = parseColumns("a,b,c,d\nP1,1,2,3\n\"\",4,5,6\n", {"_", "y", "x", "z"});
  ASSERT_EQ(headed.width, 2U) << "a column that is not read may be no number";
  EXPECT_EQ(valueOf(headed, 0, "x"), 2);
  EXPECT_EQ(valueOf(headed, 1, "y"), 4);
  const pcl::PCLPointCloud2 coloured = parseColumns("9 1 2 3 255 0 7\n", {"_", "x", "y", "z", "r", "g", "b"});
  EXPECT_EQ(namesOf(coloured), "x y z rgb");
  EXPECT_EQ(namesOf(parseColumnNames("9 1 2 3\n", true, {"_", "x", "y", "z"})), "x y z");
  EXPECT_THAT(defectOf([] {
                parseColumns("1 2 3 4\n", {"x", "y", "z"});
              }),
              HasSubstr("line 1 has 4 values, and names of 3 columns are given"));
  EXPECT_THAT(defectOf([] { parseColumns("1 2 3\n4 5 6 7\n", {"x", "y", "z"}); }), HasSubstr("line 2 has more values"));
  EXPECT_THAT(defectOf([] { parseColumns("1 2 3\n", {"x", "y", "_"}); }), HasSubstr("none of them is z"));
}

TEST(TextClouds, SurveyorsNamesAreAxes)
{
  for (const char* header : {"E N H", "Easting,Northing,Elevation", "# E N H", "//EAST NORTH HEIGHT"}) {
    const pcl::PCLPointCloud2 cloud = parseColumns(header + std::string("\n500000.25 5400000.5 7\n"));
    ASSERT_EQ(namesOf(cloud), "x y z") << header;
    EXPECT_EQ(valueOf(cloud, 0, "y"), 5400000.5) << header;
  }
  EXPECT_EQ(valueOf(parseColumns("Point;N;E;H\n1;20;10;3\n"), 0, "x"), 10);
  EXPECT_THAT(defectOf([] { parseColumns("lat,lon,h\n1,2,3\n"); }),
              HasSubstr("its columns are named lat lon h: none of them is x"));
}

TEST(TextClouds, WarnsOfAFirstColumnThatCounts)
{
  const auto remarksOf = [](const std::string& rows) {
    std::vector<std::string> remarks;
    parseColumns(rows, {}, &remarks);
    return remarks;
  };
  ASSERT_EQ(remarksOf("7 1.5 2 3\n8 4 5 6\n// a comment\n9 1 2 3\n").size(), 1U);
  EXPECT_THAT(remarksOf("0,1.5,2,3\n1,4,5,6\n2,1,2,3\n")[0], HasSubstr("counts up by one, and is taken for x"));
  EXPECT_THAT(remarksOf("0,1.5,2,3\n1,4,5,6\n2,1,2,3\n")[0], HasSubstr("--columns"));
  EXPECT_THAT(remarksOf("1 0 0 0 5 6\n2 1 1 1 5 6\n3 0 0 0 5 6\n")[0], testing::EndsWith(", as _,x,y,z,_,_"));
  for (const char* rows : {"1 1 1\n2 2 2\n3 3 3\n", "1 2 3 4\n2 2 3 4\n", "1 2 3 4\n2 2 3 4\n4 2 3 4\n",
                           "x y z i\n1 2 3 4\n2 2 3 4\n3 2 3 4\n", "0.5 2 3 4\n1.5 2 3 4\n2.5 2 3 4\n"})
    EXPECT_TRUE(remarksOf(rows).empty()) << rows;
}

TEST(TextClouds, ColoursWithoutNames)
{
  std::vector<std::string> remarks;
  const pcl::PCLPointCloud2 agisoft =
      parseColumns("1.5 2 3 200 40 33 0 0.6 0.8\n4 5 6 0 90 255 1 0 0\n7 8 9 1 2 3 0 0 0\n", {}, &remarks);
  EXPECT_EQ(namesOf(agisoft), "x y z rgb normal_x normal_y normal_z");
  EXPECT_EQ(valueOf(agisoft, 0, "normal_z"), 0.8);
  EXPECT_EQ(colourOf(agisoft, 1), 0x005affU);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(remarks[0], HasSubstr("4 to 6, whole numbers from 0 to 255, are taken for r g b, and the last three"));
  const std::string comparer = "1,2,3,200,40,33,0.5\n4,5,6,0,90,255,7\n";
  EXPECT_EQ(namesOf(parseColumns(comparer)), "x y z rgb column_7");
  EXPECT_EQ(namesOf(parseColumnNames(comparer)), "x y z rgb column_7");
  EXPECT_THAT(defectOf([&] { parseColumnNames(comparer, false); }), HasSubstr("all of its rows tell"));
  for (const char* others : {"1 2 3 0 0 1\n4 5 6 1 0 0\n",            // normals
                             "1 2 3 200 31 31\n4 5 6 100 2 2\n",      // intensity, class and return
                             "1 2 3 200 40 33\n4 5 6 256 90 255\n",   // more than bytes
                             "1 2 3 200 40 33\n4 5 6 100.5 90 255\n", // no whole number
                             "1 2 3 200 40 33\n4 5 6 -1 90 255\n"}) {
    remarks.clear();
    EXPECT_EQ(namesOf(parseColumns(others, {}, &remarks)), "x y z column_4 column_5 column_6") << others;
    EXPECT_TRUE(remarks.empty()) << others;
  }
}

TEST(TextClouds, AFileOfNamesAloneIsAnEmptyCloud)
{
  EXPECT_EQ(parseColumns("x y z r g b\n").width, 0U);
  EXPECT_EQ(namesOf(parseColumns("x y z r g b\n")), "x y z rgb");

  const auto rewritten = parseColumns("x,y,z,r,g,b\n1,2,3,200.,1e2,50.0\n1,2,3,0.0,0,00\n");
  EXPECT_EQ(namesOf(rewritten), "x y z rgb") << "whole numbers, however they are written";
  EXPECT_EQ(colourOf(rewritten, 0), 0xc86432U);
  EXPECT_EQ(namesOf(parseColumns("x,y,z,r,g,b\n1,2,3,200,100,0.5\n")), "x y z r g b");
  EXPECT_EQ(namesOf(parseColumns("//X,Y,Z\n")), "x y z");
  EXPECT_EQ(parseColumns("//X,Y,Z\n").width, 0U);
}

TEST(TextClouds, WritesColoursAsColumns)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z", "rgb"}) addField(cloud, name, Field::FLOAT32);
  allocate(cloud, 1);
  const std::uint32_t colour = 0xffff0102U; // NaN, if it were a number
  std::memcpy(&cloud.data[12], &colour, sizeof colour);
  std::ostringstream out;
  writeColumns(out, cloud);
  EXPECT_EQ(out.str(), "x y z r g b\n0 0 0 255 1 2\n");
  EXPECT_EQ(colourOf(parseColumns(out.str()), 0), 0xff0102U);
  cloud.fields[3].name = "rgba";
  std::ostringstream with_opacity;
  writeColumns(with_opacity, cloud);
  EXPECT_EQ(with_opacity.str(), "x y z r g b a\n0 0 0 255 1 2 255\n");
  EXPECT_EQ(colourOf(parseColumns(with_opacity.str()), 0, "rgba"), colour);
}

TEST(TextClouds, RefusesDamagedColumns)
{
  EXPECT_EQ(defectOf([] { parseColumns("# nothing\n"); }), "holds no points");
  EXPECT_EQ(defectOf([] { parseColumns("1 2\n"); }), "line 1 is no point: it has fewer than three numbers");
  EXPECT_EQ(defectOf([] { parseColumns("1 2 3\n4 5\n"); }), "line 2 has fewer values than it should");
  EXPECT_EQ(defectOf([] { parseColumns("1 2 3\n4 5 6 7\n"); }), "line 2 has more values than it should, from '7' on");
  EXPECT_EQ(defectOf([] { parseColumns("1 2 3\n4 five 6\n"); }), "line 2 is damaged: 'five' is not a number");
}

TEST(TextClouds, ObjVertices)
{
  const pcl::PCLPointCloud2 cloud =
      parseObj("# cube\no cube\nv 1 2 3\nvn 0 0 1\nvt 0 0\n  v 0.1 5 6 0.502 0.501961 0.5019608 # grey\nf 1 2 1\n");
  ASSERT_EQ(cloud.width, 2U);
  EXPECT_EQ(valueOf(cloud, 1, "x"), 0.1);
  EXPECT_EQ(namesOf(cloud), "x y z rgb");
  EXPECT_EQ(colourOf(cloud, 0), 0xffffffU) << "white, where others have a colour";
  EXPECT_EQ(colourOf(cloud, 1), 0x808080U);
  EXPECT_EQ(defectOf([] { parseObj("o nothing\n"); }), "has no vertices");
  EXPECT_EQ(defectOf([] { parseObj("# Vertices: 2\nv 1 2 3\n"); }),
            "is truncated: it has 1 of the 2 vertices that a comment promises");
  EXPECT_EQ(parseObj("#\n# Vertices: 0\n# Faces: 0\n").width, 0U);
  EXPECT_EQ(defectOf([] { parseObj("v 1 2 3 0.5 0.5 x\n"); }), "line 1 is damaged: 'x' is not a number");
  EXPECT_EQ(defectOf([] { parseObj("v 1 2\n"); }), "line 1 has fewer values than it should");
}

TEST(TextClouds, ObjColours)
{
  const auto colours = [](const std::string& rows) { return parseObj(rows); };
  EXPECT_EQ(colourOf(colours("v 0 0 0 1 0 1\n"), 0), 0xff00ffU) << "shares of 1";
  EXPECT_EQ(colourOf(colours("v 0 0 0 255 0 7\n"), 0), 0xff0007U);
  EXPECT_EQ(colourOf(colours("v 0 0 0 1 0 0 0.2\n"), 0, "rgba"), 0x33ff0000U);
  const pcl::PCLPointCloud2 fine = colours("v 0 0 0 0.5 0.25 0.123\nv 1 1 1\n");
  EXPECT_EQ(namesOf(fine), "x y z red green blue") << "no 255ths: kept as they are";
  EXPECT_EQ(valueOf(fine, 0, "blue"), 0.123);
  EXPECT_EQ(valueOf(fine, 1, "blue"), 1);
  EXPECT_EQ(namesOf(colours("v 0 0 0 1\n")), "x y z") << "a weight";
}

TEST(TextClouds, ObjNormals)
{
  const std::string points = "vn 0 0 1\nv 1 2 3\nv 4 5 6\nvn 0 0.6 0.8\n";
  const pcl::PCLPointCloud2 cloud = parseObj(points + "f 1//1 2//2 1//1\np 1\n");
  EXPECT_EQ(namesOf(cloud), "x y z normal_x normal_y normal_z");
  EXPECT_EQ(valueOf(cloud, 0, "normal_z"), 1);
  EXPECT_EQ(valueOf(cloud, 1, "normal_y"), 0.6);
  EXPECT_EQ(namesOf(parseObj(points + "f 1/1/2 2/1/1 1/1/1\n")), "x y z") << "of faces, not of vertices";
  EXPECT_EQ(namesOf(parseObj(points + "vn 1 0 0\n")), "x y z");
}

TEST(TextClouds, OffNormalsAndColours)
{
  const pcl::PCLPointCloud2 cloud = parseOff("CNOFF\n2 0 0\n1 2 3 0 0 1 255 0 7 128\n4 5 6 0.6 0 0.8 1 2 3 4\n");
  EXPECT_EQ(namesOf(cloud), "x y z normal_x normal_y normal_z rgba");
  EXPECT_EQ(valueOf(cloud, 1, "normal_x"), 0.6);
  EXPECT_EQ(colourOf(cloud, 0, "rgba"), 0x80ff0007U);
  EXPECT_EQ(colourOf(parseOff("STCOFF 1 0 0\n1 2 3 1 0 0 0.5 0.5\n"), 0), 0xff0000U);
  EXPECT_EQ(namesOf(parseOff("OFF 1 0 0\n1 2 3 1 0 0\n")), "x y z");
  EXPECT_EQ(namesOf(parseOffHeader("CNOFF\n1 0 0\n1 2 3 0 0 1 255 0 7\n")), "x y z normal_x normal_y normal_z rgb");
}

TEST(TextClouds, OffVertices)
{
  const pcl::PCLPointCloud2 cloud = parseOff("OFF # a triangle\n3 1 0\n\n0.1 2 3\n4 5 6\n7 8 9\n3 0 1 2\n");
  ASSERT_EQ(cloud.width, 3U);
  EXPECT_EQ(valueOf(cloud, 0, "x"), 0.1);
  EXPECT_EQ(parseOff("COFF 1 0 0\n1 2 3 255 0 0 255\n").width, 1U);
  EXPECT_EQ(parseOff("OFF 0 0 0\n").width, 0U);
}

TEST(TextClouds, OffKeywordsHaveManyForms)
{
  const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  for (const char* head :
       {"OFF4 1 0\n", "OFF 4 1 0\n", "OFF\n4 1 0\n", "OFF4\t1\n", "# made\nOFF4 1 4 # counts\n", "4 1 0\n", "4 1\n"}) {
    EXPECT_EQ(parseOff(head + rows).width, 4U) << head;
    EXPECT_EQ(parseOffHeader(head + rows).fields.size(), 3U) << head;
    const Polygons faces = parseOffFaces(head + rows);
    ASSERT_EQ(faces.size(), 1U) << head;
    EXPECT_EQ(faces[0].size(), 4U) << head;
  }
  for (const char* keyword : {"CNOFF", "NCOFF"}) {
    const pcl::PCLPointCloud2 cloud =
        parseOff(keyword + std::string("\n2 0 0\n1 2 3 0 0 1 255 0 7 9\n4 5 6 0.6 0 0.8 1 2 3 4\n"));
    EXPECT_EQ(namesOf(cloud), "x y z normal_x normal_y normal_z rgba") << keyword;
    EXPECT_EQ(valueOf(cloud, 1, "normal_x"), 0.6) << keyword;
    EXPECT_EQ(colourOf(cloud, 0, "rgba"), 0x09ff0007U) << keyword;
  }
  const pcl::PCLPointCloud2 other = parseOff("NCOFF2 0 0\n1 2 3 255 0 7 9 0 0 1\n4 5 6 1 2 3 4 0.6 0 0.8\n");
  EXPECT_EQ(valueOf(other, 1, "normal_x"), 0.6) << "as MeshLab writes it: colours first";
  EXPECT_EQ(colourOf(other, 0, "rgba"), 0x09ff0007U);
  const pcl::PCLPointCloud2 all = parseOff("NCSTOFF\n1 0 0\n1 2 3 255 0 7 9 0 0 1 0.5 0.25\n");
  EXPECT_EQ(valueOf(all, 0, "normal_z"), 1);
  EXPECT_EQ(colourOf(all, 0, "rgba"), 0x09ff0007U);
  EXPECT_EQ(namesOf(parseOff("STNOFF 1 0 0\n1 2 3 0 0 1 0.5 0.5\n")), "x y z normal_x normal_y normal_z");
  EXPECT_EQ(namesOf(parseOff("NSTOFF1 0 0\n1 2 3 0 0 1 0.5 0.5\n")), "x y z normal_x normal_y normal_z");
  EXPECT_EQ(namesOf(parseOff("COFF1 0 0\n1 2 3 255 0 0 255\n")), "x y z rgba");
  for (const char* keyword : {"4OFF", "nOFF", "4nOFF", "C4OFF", "STn4OFF", "N4nOFF", "TOFF", "CCOFF"}) {
    try {
      parseOff(keyword + std::string("\n1 0 0\n1 2 3 4\n"));
      ADD_FAILURE() << keyword;
    }
    catch (const FormatError& error) {
      EXPECT_STREQ(error.what(), "is not an OFF file: it does not start with 'OFF'");
      EXPECT_THAT(error.remedy(), HasSubstr(std::string("its keyword is ") + keyword + ", ")) << keyword;
    }
  }
  for (const char* wrong :
       {"OFFICE\n1 0 0\n1 2 3\n", "off\n1 0 0\n1 2 3\n", "OFF4x 1 0\n", "SKEL\n1 0\n", "", "-1 0 0\n"})
    EXPECT_THROW(parseOff(wrong), FormatError) << wrong;
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
  EXPECT_EQ(out.str(), "# Vertices: 2\nv 1 2 3\nv 4 5 6\n");
  std::ostringstream coloured;
  writeObj(coloured, parseColumns("//X Y Z R G B Nx Ny Nz\n1 2 3 255 128 0 0 0.6 0.8\n"));
  EXPECT_EQ(coloured.str(), "# Vertices: 1\nvn 0 0.6 0.8\nv 1 2 3 1 0.501961 0\n");
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
  cloud.fields.back().name = "\xef\xbb\xbf"
                             "b"; // as a text's first name it would be a mark
  EXPECT_EQ(defectOf([&] { writeColumns(out, cloud); }), "field '\xef\xbb\xbf"
                                                         "b' cannot name a column");
}

TEST(TextClouds, HeaderNamesTheColumns)
{
  EXPECT_EQ(parseColumnNames("1 2 3 4\n5 six\n").fields.back().name, "column_4");
  EXPECT_EQ(parseColumnNames("x y z ring\n").fields.size(), 4U);
}

/// Each of these would be read as something else than a name.
TEST(TextClouds, RefusesNamesThatReadersWouldNotTakeForNames)
{
  for (const std::string name : {"a#b", "a,b", "a;b", "a\"b", "//a", "4a",
                                 "\xff\xfe"
                                 "a",
                                 "\xfe\xff"
                                 "a"}) {
    pcl::PCLPointCloud2 cloud = parseColumns("1 2 3 4\n");
    cloud.fields.back().name = name;
    std::ostringstream out;
    EXPECT_EQ(defectOf([&] { writeColumns(out, cloud); }), "field '" + name + "' cannot name a column");
  }
  pcl::PCLPointCloud2 cloud = parseColumns("1 2 3 4\n");
  cloud.fields.back().name = "a/b";
  std::ostringstream out;
  EXPECT_NO_THROW(writeColumns(out, cloud));
}

TEST(TextClouds, ObjNeedsOneEachOfItsCoordinates)
{
  std::ostringstream out;
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y"}) addField(cloud, axis, Field::FLOAT32);
  allocate(cloud, 1);
  EXPECT_EQ(defectOf([&] { writeObj(out, cloud); }), "the cloud has not one each of x, y and z");
  addField(cloud, "z", Field::FLOAT32, 2);
  allocate(cloud, 1);
  EXPECT_EQ(defectOf([&] { writeObj(out, cloud); }), "the cloud has not one each of x, y and z") << "a list";
}

TEST(TextClouds, ObjPromisesAreWholeNumbersAlone)
{
  const std::string vertex = "v 1 2 3\n";
  EXPECT_EQ(defectOf([&] { parseObj("# vertices: 2\n" + vertex); }),
            "is truncated: it has 1 of the 2 vertices that a comment promises");
  for (const char* other : {"# Vertices: 2x\n", "# Vertices: 2 of many\n", "# Vertices: many\n", "# Vertices:\n",
                            "# Vertices: 99999999999999999999\n", "# Vertice: 2\n"})
    EXPECT_EQ(parseObj(other + vertex).width, 1U) << other;
}

TEST(TextClouds, ReadsWhatCloudCompareExports)
{
  const std::string rows = "1.5;2;3;200;100;50;0.25\n4;5;6;1;2;3;nan\n";
  for (const std::string& file :
       {"//X;Y;Z;R;G;B;Scalar field\n2\n" + rows, "2\n" + rows, "X;Y;Z;R;G;B;Scalar_field\n2\n" + rows,
        "// made by hand\n //X;Y;Z;R;G;B;C\n 2 \r\n\n" + rows}) {
    const pcl::PCLPointCloud2 cloud = parseColumns(file);
    ASSERT_EQ(cloud.width, 2U) << file;
    EXPECT_EQ(valueOf(cloud, 0, "x"), 1.5) << file;
    EXPECT_EQ(valueOf(cloud, 1, "z"), 6) << file;
    EXPECT_EQ(namesOf(parseColumnNames(file)), namesOf(cloud)) << file;
  }
  EXPECT_EQ(namesOf(parseColumns("//X;Y;Z;R;G;B;Scalar_field\n2\n" + rows)), "x y z rgb Scalar_field");
  EXPECT_EQ(namesOf(parseColumns("//X Y Z R G B Nx Ny Nz\n1\n1 2 3 4 5 6 0 0 1\n")),
            "x y z rgb normal_x normal_y normal_z");
  EXPECT_EQ(parseColumns("//X,Y,Z\n0\n").width, 0U);
  EXPECT_EQ(valueOf(parseColumns("//X,Y,Z\n1\n1,2,3\n", {"z", "y", "x"}), 0, "x"), 3);
  std::vector<std::string> remarks;
  EXPECT_EQ(parseColumns("1\n1 2 3\n4 5 6\n", {}, &remarks).width, 2U);
  EXPECT_THAT(remarks,
              ::testing::ElementsAre("its header counts 1 point, and 2 are there: all that are there are read"));
  EXPECT_EQ(defectOf([] { parseColumns("3\n1 2 3\n"); }), "is truncated: 1 of 3 points are there");
  EXPECT_EQ(defectOf([] { parseColumns("1\n2\n3\n"); }), "line 2 is no point: it has fewer than three numbers");
  EXPECT_EQ(defectOf([] { parseColumns("1.5\n1 2 3\n"); }), "line 1 is no point: it has fewer than three numbers");
}

TEST(TextClouds, NamesTheOptionForColumnsOfNames)
{
  const auto remedyOf = [](const std::string& file, const ColumnNames& names = {}) -> std::string {
    try {
      parseColumns(file, names);
    }
    catch (const FormatError& error) {
      return error.remedy();
    }
    return "was read";
  };
  EXPECT_THAT(remedyOf("P1 1 2 3\nP2 4 5 6\n"),
              HasSubstr("name the columns (--columns of programs, columns of readers), as _,x,y,z: _ is not read"));
  EXPECT_THAT(remedyOf("P1;TREE;1;2;3;7\n"), HasSubstr(", as _,_,x,y,z,column_6: _"));
  EXPECT_THAT(remedyOf("1,2,3\n4,tree,6\n"), HasSubstr("--columns"));
  EXPECT_THAT(remedyOf("1,5 2,5 3,5\n"), ::testing::Not(HasSubstr("--columns"))) << "decimal commas";
  EXPECT_EQ(valueOf(parseColumns("P1 1 2 3 tree\n", {"_", "x", "y", "z", "_"}), 0, "z"), 3);
}

} // namespace pcl_bsh::io
