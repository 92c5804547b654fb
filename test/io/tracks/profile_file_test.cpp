// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/profile_file.h>

#include <pcl_bsh/io/files/file_error.h>

#include "support/temporary_folder.h"

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string dxfOf(const std::string& entities, int unit = 6)
{
  return "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n" + std::to_string(unit) + "\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" +
         entities + "0\nENDSEC\n0\nEOF\n";
}

std::string dxfLine(double x1, double y1, double x2, double y2)
{
  return "0\nLINE\n8\n0\n10\n" + std::to_string(x1) + "\n20\n" + std::to_string(y1) + "\n30\n0\n11\n" +
         std::to_string(x2) + "\n21\n" + std::to_string(y2) + "\n31\n0\n";
}

const std::string dxf_square =
    "0\nLWPOLYLINE\n90\n4\n70\n1\n10\n-1\n20\n0\n10\n1\n20\n0\n10\n1\n20\n2\n10\n-1\n20\n2\n";
const std::string dxf_old_square =
    "0\nPOLYLINE\n66\n1\n70\n1\n10\n0\n20\n0\n0\nVERTEX\n10\n-1\n20\n0\n0\nVERTEX\n10\n1\n20\n0\n"
    "0\nVERTEX\n10\n1\n20\n2\n0\nVERTEX\n10\n-1\n20\n2\n0\nSEQEND\n";

TEST(ProfileFile, ColumnsWithNamesOrWithout)
{
  const files::TemporaryFolder folder;
  const auto square = ElementsAre(SectionPoint{-1, 0}, SectionPoint{1, 0}, SectionPoint{1, 2}, SectionPoint{-1, 2});
  EXPECT_THAT(readProfile(folder.write("a.csv", "height,offset\n0,-1\n0,1\n2,1\n2,-1\n0,-1\n")), square);
  EXPECT_THAT(readProfile(folder.write("a.txt", "# a square\n-1 0\n1 0\n1 2\n-1 2\n")), square);
  EXPECT_THAT(readProfile(folder.write("a.txt", "-1000 0\n1000 0\n1000 2000\n-1000 2000\n"), 0.001), square);
}

TEST(ProfileFile, DrawingsOfLinesAndPolylines)
{
  const files::TemporaryFolder folder;
  const auto square = ElementsAre(SectionPoint{-1, 0}, SectionPoint{1, 0}, SectionPoint{1, 2}, SectionPoint{-1, 2});
  EXPECT_THAT(readProfile(folder.write("a.dxf", dxfOf(dxf_square))), square);
  EXPECT_THAT(readProfile(folder.write("a.dxf", dxfOf(dxf_old_square))), square);
  const std::string lines = dxfLine(-1, 0, 1, 0) + dxfLine(-1, 2, 1, 2) + dxfLine(-1, 2, -1, 0) + dxfLine(1, 0, 1, 2);
  EXPECT_THAT(readProfile(folder.write("a.dxf", dxfOf(lines))), square);
  std::vector<std::string> remarks;
  const auto small = readProfile(folder.write("a.DXF", dxfOf(dxf_square + "0\nTEXT\n1\nnote\n", 4)), {}, &remarks);
  EXPECT_EQ(small[2], (SectionPoint{0.001, 0.002}));
  EXPECT_THAT(remarks, ElementsAre("1 other entity is not read", "its lengths are multiplied by 0.001"));
}

std::string profileRefusal(const char* name, const std::string& text)
{
  const files::TemporaryFolder folder;
  try {
    readProfile(folder.write(name, text));
    return {};
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr(name));
    return error.what();
  }
}

TEST(ProfileFile, RefusalsNameTheLineAndTheValue)
{
  EXPECT_THAT(profileRefusal("a.csv", "offset,height\n0,0\n1,1\n1,0\n0,1\n"),
              HasSubstr("its edges from (0, 0) to (1, 1)"));
  EXPECT_THAT(profileRefusal("a.csv", "offset,height\n0,0\n1,1\n"), HasSubstr("has 2 different corners"));
  EXPECT_THAT(profileRefusal("a.csv", "offset,height\n0,0\nnan,1\n1,0\n"),
              HasSubstr("corner 2 (nan, 1) is not finite"));
  EXPECT_THAT(profileRefusal("a.csv", "offset,width\n0,0\n"), HasSubstr("line 1 names no column height"));
  EXPECT_THAT(profileRefusal("a.csv", "0,0\n0\n"), HasSubstr("line 2 has 1 value, and the first line has 2"));
  EXPECT_THAT(profileRefusal("a.csv", "5\n6\n"), HasSubstr("line 1 has 1 column: give 2"));
  EXPECT_THAT(profileRefusal("a.dxf", dxfOf(dxfLine(0, 0, 1, 0) + dxfLine(1, 0, 1, 1))),
              HasSubstr("its outline ends at (1, 1), where no other line begins: close it"));
  EXPECT_THAT(profileRefusal("a.dxf", dxfOf(dxf_square + dxf_square)),
              HasSubstr("holds more than one outline, 1 line is left over"));
  EXPECT_THAT(profileRefusal("a.dxf", dxfOf("0\nARC\n10\n0\n")),
              HasSubstr("line 16: holds a curve, ARC: draw the outline with"));
  EXPECT_THAT(profileRefusal("a.dxf", dxfOf("0\nLWPOLYLINE\n10\n0\n20\n0\n42\n0.5\n")), HasSubstr("a bulge of 0.5"));
  EXPECT_THAT(profileRefusal("a.dxf", dxfOf("")), HasSubstr("holds no outline"));
  EXPECT_THAT(profileRefusal("a.dxf", "0\nSECTION\n2\nENTITIES\n0\n"), HasSubstr("ends within"));
  EXPECT_THAT(profileRefusal("a.dxf", "zero\nSECTION\n"), HasSubstr("line 1: 'zero' is no group code"));
  EXPECT_THAT(profileRefusal("a.dxf", "AutoCAD Binary DXF\r\n"), HasSubstr("is a binary DXF: save it as an ASCII DXF"));
}

TEST(ProfileFile, WideningByChainage)
{
  const files::TemporaryFolder folder;
  AxisDescription description;
  description.plan = {{300, 0, 0, AxisStart{0, 0, 0}}};
  description.chainages = {{0, 1000}, {100, 1100}, {100, 1050}, {300, 1250}};
  const Axis axis(description);
  const auto file = folder.write("w.csv", "chainage,left,right\n1000,0,0.1\n1200,0.5,0.2\n");
  const WideningTable table = readWidening(file, axis);
  EXPECT_DOUBLE_EQ(table.left(125), 0.25) << "distances, not chainages";
  EXPECT_DOUBLE_EQ(table.right(300), 0.2);
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      readWidening(folder.write("w.csv", text), axis);
      return {};
    }
    catch (const files::FileError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(refusal("chainage,left,right\n1075,0,0\n"),
              HasSubstr("line 2 has the chainage 1075, which the axis has more than once"));
  EXPECT_THAT(refusal("chainage,left,right\n900,0,0\n"), HasSubstr("which the axis has not"));
  EXPECT_THAT(refusal("chainage,left,right\n1000,-1,0\n"), HasSubstr("line 2 widens by -1 and 0"));
  EXPECT_THAT(refusal("chainage,left,right\n1200,0,0\n1000,0,0\n"),
              HasSubstr("line 3 has the chainage 1000, not behind"));
  EXPECT_THAT(refusal("chainage,left,right\n"), HasSubstr("holds no line of numbers"));
}

} // namespace
} // namespace pcl_bsh::io
