// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/lines/scan_text.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace pcl_bsh::io {

namespace {

const std::string identity = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

pcl::PCLPointCloud2 readPtx(const std::string& file, std::optional<std::size_t> scan = {})
{
  Viewpoint viewpoint;
  return parsePtx(file, viewpoint, scan);
}

std::array<double, 3> placeOf(const pcl::PCLPointCloud2& cloud, std::size_t i)
{
  return {valueOf(cloud, i, "x"), valueOf(cloud, i, "y"), valueOf(cloud, i, "z")};
}

using Place = std::array<double, 3>;

} // namespace

TEST(Pts, ColumnsFollowFromTheirNumber)
{
  EXPECT_EQ(namesOf(parsePts("1\n1 2 3\n")), "x y z");
  EXPECT_EQ(namesOf(parsePts("1\n1 2 3 4\n")), "x y z intensity");
  EXPECT_EQ(namesOf(parsePts("1\n1 2 3 4 5 6\n")), "x y z rgb");
  EXPECT_EQ(namesOf(parsePts("1\n1 2 3 -4 5 6 7\n")), "x y z intensity rgb");
  EXPECT_EQ(namesOf(parsePts("1\n1 2 3 -4 5 6 7 0 0 1\n")), "x y z intensity rgb column_8 column_9 column_10");
  EXPECT_EQ(namesOf(parsePts("0\n")), "x y z");
  const pcl::PCLPointCloud2 cloud = parsePts("  2 \r\n1.5 2 3e2 -1613 5 6 7\r\n\r\n+4 5 6 2047 255 0 1");
  ASSERT_EQ(cloud.width, 2U);
  EXPECT_EQ(placeOf(cloud, 0), (Place{1.5, 2, 300}));
  EXPECT_EQ(placeOf(cloud, 1), (Place{4, 5, 6}));
  EXPECT_EQ(valueOf(cloud, 0, "intensity"), -1613);
  EXPECT_EQ(colourOf(cloud, 0), 0x050607U);
  EXPECT_EQ(colourOf(cloud, 1), 0xff0001U);
}

TEST(ScanText, TakesWhatProgramsWriteForNaNAsNaN)
{
  for (const std::string nan : {"1.#QNAN", "-1.#IND", "1.#SNAN", "nan(ind)"}) {
    const pcl::PCLPointCloud2 pts = parsePts("2\n1 2 " + nan + " 4\n1 2 3 " + nan + "\n");
    ASSERT_EQ(pts.width, 2U) << nan;
    EXPECT_TRUE(std::isnan(valueOf(pts, 0, "z")) && std::isnan(valueOf(pts, 1, "intensity"))) << nan;
    const pcl::PCLPointCloud2 ptx = readPtx("1\n2\n" + identity + "1 2 3 0.5\n" + nan + " 2 3 0.5\n");
    EXPECT_TRUE(std::isnan(valueOf(ptx, 1, "x"))) << nan;
    const std::string head = "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 ";
    EXPECT_EQ(defectOf([&] { readPtx(head + nan + " 1\n1 2 3\n"); }), "line 10 ends a transform that is not finite")
        << nan;
    EXPECT_EQ(defectOf([&] { parsePts("1\n1 2 3 4 5 6 " + nan + "\n"); }),
              "line 2 has a colour that is no whole number from 0 to 255")
        << nan;
  }
}

TEST(Pts, BlocksFollowEachOther)
{
  const pcl::PCLPointCloud2 cloud = parsePts("1\n1 2 3\n2\n4 5 6\n7 8 9\n0\n");
  ASSERT_EQ(cloud.width, 3U);
  EXPECT_EQ(placeOf(cloud, 2), (Place{7, 8, 9}));
  EXPECT_EQ(parsePts("1\n1 2 3\n4 5 6\n").width, 2U) << "more than its count says";
  EXPECT_EQ(parsePts("1 2 3\n4 5 6\n").width, 2U) << "no count";
}

TEST(Pts, Damage)
{
  EXPECT_THAT(defectOf([] { parsePts("3\n1 2 3\n4 5 6\n"); }), testing::HasSubstr("truncated"));
  EXPECT_THAT(defectOf([] { parsePts("2\n1 2 3\n1\n4 5 6\n"); }), testing::HasSubstr("1 of 2"));
  EXPECT_THAT(defectOf([] { parsePts("18446744073709551615\n1 2 3\n"); }), testing::HasSubstr("18446744073709551615"));
  EXPECT_THAT(defectOf([] { parsePts("1000000000\n1 2 3\n"); }), testing::HasSubstr("truncated"));
  EXPECT_THAT(defectOf([] { parsePts("1\n1.25 2.25\n"); }), testing::HasSubstr("line 2"));
  EXPECT_THAT(defectOf([] { parsePts("2\n1 2 3\n4.25 5.25\n"); }), testing::HasSubstr("line 3"));
  EXPECT_THAT(defectOf([] { parsePts("2\n1 2 3\n4 5 6 7\n"); }), testing::HasSubstr("line 3"));
  EXPECT_THAT(defectOf([] { parsePts("2\n1 2 3 1 2 3\n4 5 6 1 2 256\n"); }), testing::HasSubstr("line 3"));
  EXPECT_THAT(defectOf([] { parsePts("1\n1 2 z\n"); }), testing::HasSubstr("line 2"));
  EXPECT_THAT(defectOf([] { parsePts("1\n1 2 1e999\n"); }), testing::HasSubstr("line 2"));
}

TEST(Ptx, OneScanIsOrganised)
{
  const std::string file = "2\n3\n" + identity +
                           "1 1 0 0.1\n1 2 0 0.2\n0 0 0 0.5\n"
                           "2 1 0 0.3\n0 0 0 0\n0 0 0 0.25\n";
  const pcl::PCLPointCloud2 cloud = readPtx(file);
  EXPECT_EQ(cloud.width, 2U);
  EXPECT_EQ(cloud.height, 3U);
  EXPECT_EQ(namesOf(cloud), "x y z intensity");
  EXPECT_EQ(placeOf(cloud, 0), (Place{1, 1, 0}));
  EXPECT_EQ(placeOf(cloud, 1), (Place{2, 1, 0})) << "the next column";
  EXPECT_EQ(placeOf(cloud, 2), (Place{1, 2, 0})) << "the next row";
  for (const std::size_t none : {3U, 4U}) EXPECT_TRUE(std::isnan(valueOf(cloud, none, "x"))) << none;
  EXPECT_EQ(placeOf(cloud, 5), (Place{0, 0, 0})) << "with an intensity, it was seen";
  EXPECT_EQ(valueOf(cloud, 4, "intensity"), 0.5);
  EXPECT_EQ(valueOf(cloud, 1, "intensity"), 0.3F);
}

TEST(Ptx, TransformsAndPoses)
{
  const std::string turned = "9 9 9\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n";
  Viewpoint viewpoint;
  const pcl::PCLPointCloud2 cloud = parsePtx("1\n1\n" + turned + "1 2 3 0.5 255 0 1\n", viewpoint);
  EXPECT_EQ(placeOf(cloud, 0), (Place{8, 21, 33}));
  EXPECT_EQ(colourOf(cloud, 0), 0xff0001U);
  const float half = std::sqrt(0.5F);
  const Viewpoint wanted = {10, 20, 30, half, 0, 0, half};
  for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(viewpoint[k], wanted[k], 1e-6) << k;
}

/// A scan of one point whose transform has that linear part, as rows are applied from the left.
std::string scanOf(const std::string& rows, const std::string& position = "5 6 7")
{
  return "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + rows + "\n" + position + " 1\n1 2 3 0.25\n";
}

TEST(Ptx, RefusesTransformsThatAreNoMotions)
{
  const std::string sound = scanOf("1 0 0 0\n0 1 0 0\n0 0 1 0");
  const std::pair<const char*, const char*> wrong[] = {
      {"1 0 0 0\n0 1 0 0\n0 0 0 0", "flattens space: it is singular"},
      {"0 0 0 0\n0 0 0 0\n0 0 0 0", "flattens space: it is singular"},
      {"1 2 3 0\n4 5 6 0\n7 8 9 0", "flattens space: it is singular"},
      {"-1 0 0 0\n0 1 0 0\n0 0 1 0", "mirrors"},
      {"0 1 0 0\n1 0 0 0\n0 0 1 0", "mirrors"},
      {"1 0.1 0 0\n0 1 0 0\n0 0 1 0", "shears or scales unevenly"},
      {"1 0 0 0\n0 1 0 0\n0 0 2 0", "shears or scales unevenly"},
  };
  for (const auto& [rows, text] : wrong) {
    for (const bool allow_scale : {false, true}) {
      Viewpoint viewpoint;
      const auto read = [&](const std::string& file, std::optional<std::size_t> scan = {}) {
        return defectOf([&] { parsePtx(file, viewpoint, scan, nullptr, allow_scale); });
      };
      EXPECT_THAT(read(scanOf(rows)), testing::HasSubstr(std::string("scan 0 has a transform that ") + text));
      EXPECT_THAT(read(sound + scanOf(rows)), testing::HasSubstr(std::string("scan 1 has a transform that ") + text));
      EXPECT_NO_THROW(parsePtx(sound + scanOf(rows), viewpoint, 0)) << "that scan alone is read";
      EXPECT_THAT(defectOf([&, &given = rows] { parsePtxHeader(scanOf(given), {}, allow_scale); }),
                  testing::HasSubstr(text));
    }
  }
}

TEST(Ptx, ScalesWhereThatIsAllowed)
{
  const std::string file = scanOf("0 0.001 0 0\n-0.001 0 0 0\n0 0 0.001 0");
  Viewpoint viewpoint;
  EXPECT_EQ(defectOf([&] { parsePtx(file, viewpoint); }), "scan 0 has a transform that scales by 0.001");
  try {
    parsePtx(file, viewpoint);
    ADD_FAILURE() << "it scales";
  }
  catch (const FormatError& error) {
    EXPECT_THAT(error.remedy(), testing::HasSubstr("give --allow-scale if that is meant"));
  }
  std::vector<std::string> remarks;
  const pcl::PCLPointCloud2 cloud = parsePtx(file, viewpoint, {}, nullptr, true, &remarks);
  EXPECT_EQ(placeOf(cloud, 0), (Place{5 - 0.002, 6 + 0.001, 7 + 0.003}));
  EXPECT_NEAR(viewpoint[3], std::sqrt(0.5), 1e-15) << "a rotation without scale";
  EXPECT_NEAR(viewpoint[6], std::sqrt(0.5), 1e-15);
  EXPECT_TRUE(remarks.empty());
}

TEST(Ptx, PrintedDigitsStandForTheNearestRotation)
{
  const std::string turn = "0.8 0.60002 0 0\n-0.6 0.8 0 0\n0 0 1 0",
                    six = "0.877583 0.479426 0 0\n-0.479426 0.877583 0 0\n0 0 1 0";
  std::vector<std::string> remarks;
  Viewpoint viewpoint;
  const pcl::PCLPointCloud2 cloud = parsePtx(scanOf(six) + scanOf(turn) + scanOf("1 0 0 0\n0 1 0 0\n0 0 1 0"),
                                             viewpoint, {}, nullptr, false, &remarks);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(remarks[0], testing::HasSubstr("transform of scan 1, the worst of 2: |R'R - I| is "));
  EXPECT_THAT(remarks[0], testing::HasSubstr("the nearest rotation is used"));
  const Place p = placeOf(cloud, 1);
  EXPECT_NEAR(std::hypot(p[0] - 5, p[1] - 6, p[2] - 7), std::sqrt(14.0), 1e-14) << "nothing is stretched";
  EXPECT_EQ(placeOf(cloud, 2), (Place{6, 8, 10}));
}

TEST(Ptx, SeveralScans)
{
  const std::string moved = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 7 1\n";
  const std::string file = "2\n1\n" + identity + "1 1 1 0.1\n2 2 2 0.2\n" + "1\n2\n" + moved + "3 3 3 0.3\n0 0 0 0.5\n";
  const pcl::PCLPointCloud2 all = readPtx(file);
  EXPECT_EQ(namesOf(all), "x y z intensity scan");
  ASSERT_EQ(all.width, 4U);
  EXPECT_EQ(all.height, 1U);
  EXPECT_EQ(placeOf(all, 2), (Place{3, 3, 10}));
  EXPECT_TRUE(std::isnan(valueOf(all, 3, "z")));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(valueOf(all, i, "scan"), static_cast<double>(i / 2));

  Viewpoint viewpoint;
  const pcl::PCLPointCloud2 second = parsePtx(file, viewpoint, 1);
  EXPECT_EQ(namesOf(second), "x y z intensity");
  EXPECT_EQ(second.width, 1U);
  EXPECT_EQ(second.height, 2U);
  EXPECT_EQ(viewpoint[2], 7);
  EXPECT_EQ(namesOf(parsePtxHeader(file, 1)), "x y z intensity");
  EXPECT_EQ(namesOf(parsePtxHeader(file)), namesOf(all));
  EXPECT_THAT(defectOf([&] { readPtx(file, 2); }), testing::HasSubstr("2 scans"));
}

TEST(Ptx, CutAnywhere)
{
  const std::string file = "2\n1\n" + identity + "1 1 1 0.125\n2 2 2 0.25\n";
  for (std::size_t size = 1; size < file.size() - 4; ++size) {
    EXPECT_NE(defectOf([&] { readPtx(file.substr(0, size)); }), "") << size;
  }
}

TEST(Ptx, Damage)
{
  EXPECT_THAT(defectOf([] { readPtx("4294967295\n4294967295\n" + identity + "1 2 3 4\n"); }),
              testing::HasSubstr("points"));
  EXPECT_THAT(
      defectOf([] { readPtx("1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\nnan 0 0 1\n1 2 3\n"); }),
      testing::HasSubstr("line 10"));
  EXPECT_THAT(
      defectOf([] { readPtx("1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n1 2 3\n"); }),
      testing::HasSubstr("line 10"));
  EXPECT_THAT(defectOf([] { readPtx("1\n2\n" + identity + "1 2 3 4\n5 6 7\n"); }), testing::HasSubstr("line 12"));
}

std::string printedPts(const pcl::PCLPointCloud2& cloud)
{
  std::ostringstream out;
  writePts(out, cloud);
  return out.str();
}

std::string printedPtx(const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint = no_viewpoint)
{
  std::ostringstream out;
  writePtx(out, cloud, viewpoint);
  return out.str();
}

TEST(Pts, WrittenAsItWasRead)
{
  for (const std::string points : {"0.1 2 3\n-4.25 5e+22 6\n", "0.1 2 3 -17\n4 5 6 0.5\n", "0.1 2 3 10 20 255\n",
                                   "1 2 3 0.5 10 20 30\n", "1 2 3 0.5 10 20 30 40 50.5\n", "1 2 3 0.5 7\n"}) {
    const std::string file = std::to_string(std::count(points.begin(), points.end(), '\n')) + '\n' + points;
    EXPECT_EQ(printedPts(parsePts(file)), file);
  }
  EXPECT_EQ(printedPts(parsePts("0\n")), "0\n");
  const pcl::PCLPointCloud2 holes = readPtx("3\n1\n" + identity + "1 1 1 0.25\n0 0 0 0\n2 2 2 0.125\n");
  EXPECT_EQ(printedPts(holes), "2\n1 1 1 0.25\n2 2 2 0.125\n") << "without points that nobody saw";
}

TEST(Pts, RefusesWhatReadersWouldTakeForSomethingElse)
{
  // Seven values are an intensity and colours; a field of another name has no place.
  for (const std::string header : {"x,y,z,rings", "x,y,z,intensity,column_5,column_6", "x,y,z,column_4"}) {
    const pcl::PCLPointCloud2 cloud = parseColumns(header + "\n1,2,3,4" + (header.size() > 15 ? ",5,6\n" : "\n"));
    EXPECT_THAT(defectOf([&] { printedPts(cloud); }), testing::HasSubstr("has no place in a .pts")) << header;
  }
  const pcl::PCLPointCloud2 coloured = parseColumns("x,y,z,red,green,blue,alpha\n1,2,3,4,5,6,7\n");
  EXPECT_THAT(defectOf([&] { printedPts(coloured); }), testing::HasSubstr("field 'alpha' has no place in a .pts"));
}

TEST(Ptx, WrittenAsItWasRead)
{
  for (const std::string& body :
       std::vector<std::string>{"2\n3\n" + identity + "1 1 0 0.1\n1 2 0 0.2\n0 0 0 0\n2 1 0 0.3\n0 0 0 0\n0 0 0 0.25\n",
                                "1\n2\n" + identity + "0.1 2 3 0.5 255 0 1\n0 0 0 0 0 0 0\n",
                                "2\n1\n" + identity + "1 1 1 0.1\n2 2 2 0.2\n" + "1\n1\n" + identity + "3 3 3 0.3\n"}) {
    EXPECT_EQ(printedPtx(readPtx(body)), body);
  }
}

TEST(Ptx, KeepsTheScannersPose)
{
  const std::string turned =
      "9 9 9\n1 0 0\n0 1 0\n0 0 1\n0.8 0.6 0 0\n-0.6 0.8 0 0\n0 0 1 0\n500000.123456789 5400000.1 30 1\n";
  Viewpoint viewpoint, again;
  const auto cloud = parsePtx("1\n2\n" + turned + "1 2 3 0.25\n0 0 0 0.5\n", viewpoint);
  const auto same = parsePtx(printedPtx(cloud, viewpoint), again);
  for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(again[k], viewpoint[k], k < 3 ? 0 : 1e-15) << k;
  EXPECT_EQ(viewpoint[0], 500000.123456789);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(placeOf(same, 0)[k], placeOf(cloud, 0)[k], 2e-9) << k;
  EXPECT_TRUE(std::isnan(valueOf(same, 1, "x")));
  EXPECT_EQ(same.height, 2U);
}

TEST(Ptx, RefusesAPointThatReadersWouldNotSee)
{
  EXPECT_THAT(defectOf([] { printedPtx(parsePts("1 2 3\n0 0 0\n")); }),
              testing::HasSubstr("point 1 is at the scanner"));
  EXPECT_THAT(printedPtx(parsePts("1 2 3 0.1\n0 0 0 0.1\n")), testing::HasSubstr("\n0 0 0 0.1\n"));
}

TEST(Csv, NamesDecideTheColumns)
{
  const TemporaryFolder folder;
  const auto path = folder.write("a.csv", "id,Z,X,Y,Intensity,R,G,B\n1,30,10,20,0.5,255,0,1\n2,31,11,21,0.25,0,0,0\n");
  const pcl::PCLPointCloud2 cloud = readCloud(path);
  EXPECT_EQ(namesOf(cloud), "id z x y intensity rgb");
  EXPECT_EQ(placeOf(cloud, 1), (Place{11, 21, 31}));
  EXPECT_EQ(colourOf(cloud, 0), 0xff0001U);
  writeCloud(folder / "b.csv", cloud);
  EXPECT_EQ(contentOf(folder / "b.csv"), "id,z,x,y,intensity,r,g,b\n1,30,10,20,0.5,255,0,1\n2,31,11,21,0.25,0,0,0\n");
}

TEST(Csv, QuotesAroundWordsDoNotCount)
{
  const pcl::PCLPointCloud2 cloud = parseColumns("\"x\",\"y\",\"z\",\"my value\"\n1,2,3,4\n\"5\",\"6\",\"7\",\"8\"\n");
  EXPECT_EQ(namesOf(cloud), "x y z my_value");
  ASSERT_EQ(cloud.width, 2U);
  EXPECT_EQ(placeOf(cloud, 1), (Place{5, 6, 7}));
  const TemporaryFolder folder;
  const std::string named = "x,y,z,name\n1,2,3,\"pipe, 2; bent\"\n4,5,6,valve\n";
  writeCloud(folder / "b.csv", readCloud(folder.write("a.csv", named)));
  EXPECT_EQ(contentOf(folder / "b.csv"), named) << "separators within quotes do not count";
  EXPECT_EQ(parseColumns("x;y;z;name\n1;2;3;\"a;b,c\"\n").width, 1U);
}

TEST(ScanText, RealFiles)
{
  namespace fs = std::filesystem;
  const fs::path samples = fs::path(PCL_BSH_SHARED_DIR) / "data/formats";
  if (!fs::exists(samples)) GTEST_SKIP() << "no " << samples;
  EXPECT_EQ(readCloud(samples / "autzen.pts").width, 10U);
  EXPECT_EQ(valueOf(readCloud(samples / "autzen.pts"), 0, "intensity"), -1613);
  EXPECT_EQ(readCloud(samples / "bunny_8.pts").width, 9U) << "one more than its count says";
  EXPECT_EQ(readCloud(samples / "site_56_8.pts").width, 8U);

  CloudFacts facts;
  const Viewpoint& viewpoint = facts.viewpoint;
  const pcl::PCLPointCloud2 one = readCloud(samples / "complex-transform.ptx", &facts);
  EXPECT_EQ(one.width, 2U);
  EXPECT_EQ(one.height, 6U);
  EXPECT_FALSE(one.is_dense);
  EXPECT_NEAR(viewpoint[0], -3.028748, 1e-6);
  EXPECT_NEAR(viewpoint[3], 1, 1e-4);

  for (const bool allow_scale : {false, true}) { // of z alone
    try {
      readCloud(samples / "multiple-and-transform.ptx", &facts, {{}, allow_scale});
      ADD_FAILURE() << "it scales unevenly";
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("multiple-and-transform.ptx: scan 0 has a transform that shears or "
                                                   "scales unevenly: |R'R - I| is 3: export it again"));
    }
  }
  std::string even = contentOf(samples / "multiple-and-transform.ptx");
  for (const std::string uneven : {"0 0 2 0\n", "0 0 2 0\r\n"})
    for (std::size_t at = even.find(uneven); at != std::string::npos; at = even.find(uneven)) even[at + 4] = '1';
  Viewpoint first;
  const pcl::PCLPointCloud2 two = parsePtx(even, first);
  ASSERT_EQ(two.width, 8U);
  EXPECT_EQ(first[0], 600000);
}

TEST(Pts, HeadersHaveTheFields)
{
  EXPECT_EQ(namesOf(parsePtsHeader("2\n1 2 3 -4 5 6 7\n8 9 broken")), "x y z intensity rgb");
  EXPECT_EQ(namesOf(parsePtsHeader("1 2 3\n")), "x y z") << "no count";
  EXPECT_EQ(parsePtsHeader("1\n1 2 3\n").width, 0U);
  EXPECT_THAT(defectOf([] { parsePtsHeader("1\n1.25 2.25\n"); }),
              testing::HasSubstr("line 2 is no point: it has fewer than three numbers"));
  EXPECT_EQ(defectOf([] { parsePts("1\n\n\n\n\n\n\n\n"); }),
            "is truncated: its header promises points, and there are none");
}

/// Three or six numbers are no intensity: what is at the scanner was not seen, whatever its colour.
TEST(Ptx, WithoutIntensitiesNothingIsSeenAtTheScanner)
{
  for (const std::string rest : {"", " 255 0 0"}) {
    const pcl::PCLPointCloud2 cloud = readPtx("1\n2\n" + identity + "0 0 0" + rest + "\n0 0 1" + rest + '\n');
    EXPECT_TRUE(std::isnan(valueOf(cloud, 0, "x"))) << rest;
    EXPECT_EQ(placeOf(cloud, 1), (Place{0, 0, 1})) << rest;
  }
  for (const std::string axis : {"1 0 0", "0 1 0", "0 0 1"})
    EXPECT_FALSE(std::isnan(valueOf(readPtx("1\n1\n" + identity + axis + " 0\n"), 0, "x"))) << axis;
}

TEST(Ptx, AScanMayBeEmpty)
{
  for (const std::string size : {"0\n0\n", "2\n0\n", "0\n2\n"}) {
    const pcl::PCLPointCloud2 cloud = readPtx(size + identity);
    EXPECT_EQ(cloud.width, 0U);
    EXPECT_EQ(cloud.height, 1U) << size;
    EXPECT_EQ(namesOf(cloud), "x y z");
  }
  const pcl::PCLPointCloud2 second = readPtx("0\n1\n" + identity + "1\n1\n" + identity + "1 2 3 0.25\n");
  EXPECT_EQ(namesOf(second), "x y z intensity scan");
  EXPECT_EQ(valueOf(second, 0, "scan"), 1);
  EXPECT_THAT(defectOf([] { readPtx("1\n1\n" + identity + "1 2 \n\n\n\n\n"); }),
              testing::HasSubstr("is followed by no point"));
}

/// A scanner that stands nowhere, or looks nowhere: points stay where they are.
TEST(Ptx, APoseThatIsNoneMovesNothing)
{
  const pcl::PCLPointCloud2 cloud = parsePts("1 2 3 0.5\n");
  const std::string unmoved = printedPtx(cloud);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Viewpoint& viewpoint : {Viewpoint{1, 2, 3, 0, 0, 0, 0}, Viewpoint{1, nan, 3, 1, 0, 0, 0}})
    EXPECT_EQ(printedPtx(cloud, viewpoint), unmoved);
}

TEST(Ptx, RefusesEachIntensityThatMeansNothingSeen)
{
  for (const char* unseen : {"0", "0.5"})
    EXPECT_THAT(defectOf([&] { printedPtx(parsePts("1 2 3 1\n0 0 0 " + std::string(unseen) + '\n')); }),
                testing::HasSubstr("point 1 is at the scanner"))
        << unseen;
  EXPECT_NO_THROW(printedPtx(parsePts("1 2 3 1\n0 0 0 0.25\n")));
  EXPECT_NO_THROW(printedPtx(parsePts("1 2 3 0\n"))) << "elsewhere it may have any";
}

/// Texts of float32 have no digits that it does not have, and only numbers with a place.
TEST(Pts, WritesWhatFieldsHold)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, Field::FLOAT32);
  addField(cloud, "intensity", Field::FLOAT32);
  allocate(cloud, 1);
  const float numbers[] = {0.1F, 0.2F, 0.3F, 0.4F};
  std::memcpy(cloud.data.data(), numbers, sizeof numbers);
  EXPECT_EQ(printedPts(cloud), "1\n0.1 0.2 0.3 0.4\n");

  pcl::PCLPointCloud2 lists = cloud;
  lists.fields[3].offset = 4;
  lists.fields[3].count = 3;
  EXPECT_EQ(defectOf([&] { printedPts(lists); }), "field 'intensity' has no place in a .pts");
  const pcl::PCLPointCloud2 fine = parseColumns("x,y,z,red,green,blue\n1,2,3,0.5,0.25,0.5\n");
  EXPECT_EQ(defectOf([&] { printedPts(fine); }), "field 'red' has no place in a .pts");
  const pcl::PCLPointCloud2 two = parseColumns("x,y,z,red,green\n1,2,3,0,1\n");
  EXPECT_EQ(defectOf([&] { printedPts(two); }), "field 'red' has no place in a .pts");
}

TEST(Pts, TellsWhichFieldsHaveAPlace)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z", "intensity", "rgb", "column_8", "column", "scan", "ring"})
    addField(cloud, name, Field::FLOAT32);
  const auto held = [&](bool several_scans) {
    std::string names;
    for (const Field& field : fieldsForScans(cloud, several_scans)) names += field.name + ' ';
    return names;
  };
  EXPECT_EQ(held(false), "x y z intensity rgb column_8 ");
  EXPECT_EQ(held(true), "x y z intensity rgb column_8 scan ");
}

TEST(Pts, MayBeColumns)
{
  for (const char* file : {"x,y,z\n1.5,2,3\n4,5,6\n", "X Y Z\n1.5 2 3\n4 5 6\n", "//X;Y;Z\n2\n1.5;2;3\n4;5;6\n",
                           "1.5,2,3\n4,5,6\n", "# made\n1.5 2 3\n4 5 6\n", "x,y,z\r\n2\r\n1.5,2,3\r\n4,5,6"}) {
    const pcl::PCLPointCloud2 cloud = parsePts(file);
    ASSERT_EQ(cloud.width, 2U) << file;
    EXPECT_EQ(placeOf(cloud, 0), (Place{1.5, 2, 3})) << file;
    EXPECT_EQ(namesOf(parsePtsHeader(file)), "x y z") << file;
  }
  EXPECT_EQ(namesOf(parsePts("x,y,z,intensity,r,g,b\n1,2,3,0.5,4,5,6\n")), "x y z intensity rgb");
  const TemporaryFolder folder;
  EXPECT_EQ(readCloud(folder.write("a.pts", "x,y,z\n1,2,3\n")).width, 1U);
  EXPECT_EQ(readCloudHeader(folder / "a.pts").fields.size(), 3U);
}

TEST(PtsFile, ColumnsOfWordsAreReadWhereTheFirstLineNamesThem)
{
  for (const char* file : {"2\n1 2 3 wall\n4 5 6 7\n", "1 2 3 4\n4 5 6 wall\n"}) {
    try {
      parsePts(file);
      ADD_FAILURE() << file;
    }
    catch (const FormatError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("'wall' is not a number"));
      EXPECT_THAT(error.remedy(), testing::HasSubstr("name all columns in a first line")) << file;
    }
  }
  EXPECT_EQ(namesOf(parsePts("x y z name\n1 2 3 wall\n4 5 6 floor\n")), "x y z name");
}

} // namespace pcl_bsh::io
