// SPDX-License-Identifier: BSD-3-Clause
#include "defect.h"

#include <pcl_bsh/io/text/column_names.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

using ::testing::HasSubstr;

TEST(ColumnNames, AreSeparatedByCommas)
{
  EXPECT_EQ(columnNamesOf("x,y,z"), (ColumnNames{"x", "y", "z"}));
  EXPECT_EQ(columnNamesOf("_, E , N,_,H"), (ColumnNames{"_", "E", "N", "_", "H"}));
  for (const char* text : {"", "x,,z", "x,y,", ",x", "x, ,z"})
    EXPECT_THAT(defectOf([&] { columnNamesOf(text); }), HasSubstr("a column without a name")) << text;
  EXPECT_THAT(defectOf([] { columnNamesOf("x,y,z,y"); }), HasSubstr("names two columns y"));
}

TEST(ColumnNames, SurveyorsNamesAreAxes)
{
  const ColumnNames axes = {"x", "y", "z"};
  EXPECT_EQ(withAxes({"E", "N", "H"}), axes);
  EXPECT_EQ(withAxes({"easting", "NORTHING", "Height"}), axes);
  EXPECT_EQ(withAxes({"East", "North", "Elevation"}), axes);
  EXPECT_EQ(withAxes({"N", "E", "Z"}), (ColumnNames{"y", "x", "Z"}));
  EXPECT_EQ(withAxes({"N", "x", "y", "z"}), (ColumnNames{"N", "x", "y", "z"})) << "a number, beside y";
  EXPECT_EQ(withAxes({"E", "N", "H", "Height"}), (ColumnNames{"x", "y", "H", "Height"})) << "either may be z";
}

TEST(ColumnChoice, OneForAllAndOneForAFile)
{
  ColumnChoice choice;
  EXPECT_TRUE(choice.of("a.xyz").empty());
  choice.add("_,x,y,z");
  choice.add("a=b.csv=x,y,z");
  EXPECT_EQ(choice.of("other.TXT"), columnNamesOf("_,x,y,z"));
  EXPECT_EQ(choice.of("-"), columnNamesOf("_,x,y,z"));
  EXPECT_EQ(choice.of("a=b.csv"), columnNamesOf("x,y,z"));
  EXPECT_TRUE(choice.of("a.las").empty());
  choice.requireUsed({"a=b.csv", "other.txt", "a.las"});
  EXPECT_THAT(defectOf([&] { choice.requireUsed({"b.csv", "other.txt"}); }), HasSubstr("a=b.csv, which is not read"));
  EXPECT_THAT(defectOf([&] { choice.add("x,y,z"); }), HasSubstr("given twice"));
  EXPECT_THAT(defectOf([&] { choice.add("a=b.csv=x,y,z"); }), HasSubstr("given twice for a=b.csv"));
  ColumnChoice all;
  all.add("x,y,z");
  EXPECT_THAT(defectOf([&] {
                all.requireUsed({"a.las", "b.ply"});
              }),
              HasSubstr("no .xyz, .asc, .txt or .csv file is read"));
}

TEST(ColumnNames, AreOfFourKindsOfFiles)
{
  for (const char* extension : {".xyz", ".asc", ".txt", ".csv"}) {
    EXPECT_TRUE(isColumnText(extension)) << extension;
    ColumnChoice all;
    all.add("x,y,z");
    EXPECT_NO_THROW(all.requireUsed({"a.las", std::string("a") + extension})) << extension;
    EXPECT_EQ(all.of(std::string("a") + extension).size(), 3U) << extension;
  }
  for (const char* other : {"", ".ply", "xyz", ".xyzw", ".pts"}) EXPECT_FALSE(isColumnText(other)) << other;
  ColumnChoice all;
  all.add("x,y,z");
  EXPECT_NO_THROW(all.requireUsed({"-"})) << "a pipe may be of columns";
}

} // namespace
} // namespace pcl_bsh::io
