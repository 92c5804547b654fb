// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/io/clouds/pcd/pcd.h>

#include <pcl/io/pcd_io.h>

namespace pcl_bsh::io {

namespace {

std::string header(const std::string& fields, const std::string& sizes, const std::string& types, std::size_t points,
                   const std::string& storage)
{
  const std::string count = std::to_string(points);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " + count +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA " + storage + "\n";
}

std::string xyzHeader(std::size_t points, const std::string& storage)
{
  return header("x y z", "4 4 4", "F F F", points, storage);
}

pcl::PCLPointCloud2 parse(const std::string& file)
{
  Viewpoint viewpoint;
  return parsePcd(file, viewpoint);
}

std::string defect(const std::string& file)
{
  return defectOf([&] { parse(file); });
}

std::string written(const pcl::PCLPointCloud2& cloud)
{
  std::ostringstream out;
  writePcd(out, cloud, no_viewpoint);
  return out.str();
}

template <typename T>
std::string bytesOf(std::initializer_list<T> values)
{
  return {reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(T)};
}

} // namespace

TEST(Pcd, EveryTypeComesBackAsItWas)
{
  const pcl::PCLPointCloud2 cloud = randomCloud<float>(1000, 3, pcd_datatypes);
  expectSame(parse(written(cloud)), cloud);
  const pcl::PCLPointCloud2 georeferenced = randomCloud<double>(100, 1, {});
  expectSame(parse(written(georeferenced)), georeferenced);
}

TEST(Pcd, ViewpointComesBackToTheLastBit)
{
  const Viewpoint viewpoint = {0.1, 1.0 / 3, -1e-7, 0.7071067811865476, 0, 0.7071067811865475, 5400000.123456789};
  std::ostringstream out;
  writePcd(out, randomCloud<float>(1, 1, {}), viewpoint);
  Viewpoint read;
  parsePcd(out.str(), read);
  EXPECT_EQ(read, viewpoint);
}

TEST(Pcd, AxesMayBeCapitals)
{
  const auto file = [](const std::string& names) {
    return "FIELDS " + names + "\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n1 2 3 4\n";
  };
  EXPECT_EQ(namesOf(parse(file("X Y Z Intensity"))), "x y z Intensity");
  EXPECT_EQ(valueOf(parse(file("Intensity Z Y X")), 0, "x"), 4);
  EXPECT_EQ(namesOf(parsePcdHeader(file("X y z i"))), "x y z i");
  EXPECT_EQ(namesOf(parse(file("X x y z"))), "X x y z") << "the name is taken";
}

TEST(Pcd, EmptyCloudKeepsItsFields)
{
  const pcl::PCLPointCloud2 cloud = randomCloud<float>(0, 1, ply_datatypes);
  expectSame(parse(written(cloud)), cloud);
  EXPECT_EQ(parse(xyzHeader(0, "ascii")).width, 0U);
}

TEST(Pcd, PaddingOfRecordsIsNotWritten)
{
  pcl::PCLPointCloud2 padded;
  addField(padded, "x", Field::FLOAT32);
  addField(padded, "y", Field::FLOAT32);
  addField(padded, "z", Field::FLOAT32);
  addPadding(padded, 4);
  addField(padded, "intensity", Field::FLOAT32);
  addField(padded, "_", Field::UINT8, 12);
  allocate(padded, 2);
  const pcl::PCLPointCloud2 cloud = parse(written(padded));
  EXPECT_EQ(cloud.point_step, 16U);
  EXPECT_EQ(cloud.fields.size(), 4U);
}

TEST(Pcd, ReadsBinaryWithPadding)
{
  const std::string file = header("x y _ z", "4 4 4 4", "F F F F", 2, "binary") +
                           bytesOf<float>({1, 2, 99, 3, 4, 5, 99, 6}) + "trailing bytes are no points";
  const pcl::PCLPointCloud2 cloud = parse(file);
  ASSERT_EQ(cloud.fields.size(), 3U);
  EXPECT_EQ(valueOf(cloud, 1, "y"), 5);
  EXPECT_EQ(valueOf(cloud, 1, "z"), 6);
}

TEST(Pcd, ReadsAscii)
{
  const std::string file =
      "VERSION .7\r\nFIELDS x y z label normal\r\nSIZE 8 8 8 2 4\r\nTYPE F F F U F\r\nCOUNT 1 1 1 1 2\r\n"
      "POINTS 2\r\nDATA ascii\r\n596648.125000001 0.1 nan 65535 1 2\r\n\r\n4 5 6 7 8 9";
  const pcl::PCLPointCloud2 cloud = parse(file);
  EXPECT_EQ(cloud.width, 2U);
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(valueOf(cloud, 0, "x"), 596648.125000001);
  EXPECT_TRUE(std::isnan(valueOf(cloud, 0, "z")));
  EXPECT_EQ(valueOf(cloud, 0, "label"), 65535);
  EXPECT_EQ(valueOf(cloud, 1, "normal"), 8);
}

TEST(Pcd, ReadsWhatPclWrites)
{
  const TemporaryFolder folder;
  const std::string name = (folder / "cloud.pcd").string();
  const pcl::PCLPointCloud2 cloud = randomCloud<float>(20, 5, ply_datatypes);
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  pcl::PCDWriter writer;
  writer.writeBinary(name, cloud, origin, orientation);
  expectSame(parse(contentOf(name)), cloud);
  writer.writeBinaryCompressed(name, cloud, origin, orientation);
  expectSame(parse(contentOf(name)), cloud);
  writer.writeASCII(name, cloud, origin, orientation, 17);
  const pcl::PCLPointCloud2 ascii = parse(contentOf(name));
  EXPECT_EQ(valueOf(ascii, 99, "x"), valueOf(cloud, 99, "x"));
  EXPECT_EQ(valueOf(ascii, 99, "field_" + std::to_string(Field::UINT16)),
            valueOf(cloud, 99, "field_" + std::to_string(Field::UINT16)));
}

TEST(Pcd, PclReadsWhatIsWritten)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = randomCloud<double>(20, 5, pcd_datatypes);
  pcl::PCLPointCloud2 read;
  ASSERT_EQ(pcl::PCDReader().read(folder.write("cloud.pcd", written(cloud)).string(), read), 0);
  expectSame(read, cloud);
}

TEST(Pcd, RefusesTruncatedPoints)
{
  const std::string binary = xyzHeader(3, "binary") + std::string(35, 'x');
  EXPECT_EQ(defect(binary), "is truncated: its header promises 3 points, its size allows 2 at most");
  EXPECT_EQ(defect(xyzHeader(3, "ascii") + "1 2 3.25\n4 5 6\n 7 8"), "line 13 has fewer values than it should");
  EXPECT_EQ(defect(xyzHeader(3, "ascii") + "1.25 2.25 3.25\n4 5 6\n\n"),
            "is truncated: it ends before the last of its points");
  const std::string compressed = written(randomCloud<float>(100, 1, {}));
  for (std::size_t cut = 1; cut < compressed.size(); cut += 7) {
    EXPECT_THROW(parse(compressed.substr(0, compressed.size() - cut)), FormatError) << cut;
  }
}

TEST(Pcd, RefusesHeadersThatLie)
{
  EXPECT_EQ(defect(xyzHeader(2147483647, "binary") + "x"),
            "is truncated: its header promises 2147483647 points, its size allows 0 at most");
  EXPECT_EQ(defect(xyzHeader(3000000000, "binary")),
            "it has 3000000000 points, more than the 2147483647 that an index can name");
  EXPECT_EQ(defect(xyzHeader(1, "ascii") + "1 2 3\n4 5 6\n"), "line 12 is one more point than the header promises");
  EXPECT_EQ(defect(xyzHeader(1, "ascii") + "1 2 3 4\n"), "line 11 has more values than it should, from '4' on");
  EXPECT_EQ(defect(xyzHeader(1, "ascii") + "1 two 3\n"), "line 11 is damaged: 'two' is not a number");
  EXPECT_EQ(defect("FIELDS x\nSIZE 4\nTYPE F\nWIDTH 2\nHEIGHT 2\nPOINTS 5\nDATA binary\n" + std::string(99, 'x')),
            "its header says 2 x 2 and 5 points, which disagree");
  EXPECT_EQ(defect("FIELDS x\nSIZE 4\nTYPE F\nDATA ascii\n1\n"), "its header has no POINTS line");
  EXPECT_EQ(defect("FIELDS x y\nSIZE 4\nTYPE F\nPOINTS 1\nDATA ascii\n1\n"),
            "its FIELDS, SIZE, TYPE and COUNT lines differ in length");
  EXPECT_EQ(defect("POINTS 1\nDATA ascii\n1\n"), "its header names no fields");
  EXPECT_EQ(defect(header("x", "3", "F", 1, "binary") + "abc"),
            "field 'x' has type F, size 3 and count 1, which is no PCD field");
  EXPECT_EQ(defect("FIELDS x\nSIZE 4\nTYPE F\nCOUNT 0\nPOINTS 1\nDATA ascii\n1\n"),
            "field 'x' has type F, size 4 and count 0, which is no PCD field");
  EXPECT_EQ(defect("FIELDS x\nSIZE 8\nTYPE F\nCOUNT 4294967295\nPOINTS 1\nDATA ascii\n1\n"),
            "a point takes more than 4 GiB");
  EXPECT_EQ(defect(xyzHeader(1, "zip")), "its points are stored as 'zip'");
  EXPECT_EQ(defect("FIELDS x\n"), "is not a PCD file: it has no DATA line");
  EXPECT_EQ(defect("solid cube\n"), "line 1 starts with 'solid', which no PCD header has");
}

TEST(Pcd, RefusesCompressedSizesThatLie)
{
  const std::string head = xyzHeader(1000, "binary_compressed");
  EXPECT_EQ(defect(head + "abc"), "is truncated: its compressed points are missing");
  EXPECT_EQ(defect(head + bytesOf<std::uint32_t>({100, 12000}) + "abc"),
            "is truncated: 3 of 100 compressed bytes are there");
  EXPECT_EQ(defect(head + bytesOf<std::uint32_t>({3, 11000}) + "abc"),
            "its compressed points are 11000 bytes, its header promises 12000");
  EXPECT_EQ(defect(head + bytesOf<std::uint32_t>({3, 12000}) + "abc"),
            "its compressed points are 12000 bytes, its header promises 12000");
  EXPECT_EQ(defect(head + bytesOf<std::uint32_t>({200, 12000}) + std::string(200, '\x05')),
            "its compressed points are damaged");
}

TEST(Pcd, RefusesFieldsThatNoHeaderCanName)
{
  pcl::PCLPointCloud2 cloud;
  addField(cloud, "a b", Field::FLOAT32);
  EXPECT_EQ(defectOf([&] { written(cloud); }), "a field named 'a b' cannot be written");
  EXPECT_EQ(defectOf([] { written({}); }), "the cloud has no fields");
}

TEST(Pcd, FieldsMayBeCalledColumns)
{
  EXPECT_EQ(namesOf(parse("COLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n")), "x y z");
}

/// A column that is read and not kept.
TEST(Pcd, ReadsAsciiWithPadding)
{
  const std::string head = "FIELDS x _ y z\nSIZE 4 1 4 4\nTYPE F U F F\nCOUNT 1 2 1 1\nPOINTS 2\nDATA ascii\n";
  const pcl::PCLPointCloud2 cloud = parse(head + "1 9 9 2 3\n4 9 9 5 6\n");
  EXPECT_EQ(namesOf(cloud), "x y z");
  EXPECT_EQ(cloud.point_step, 12U);
  EXPECT_EQ(valueOf(cloud, 1, "x"), 4);
  EXPECT_EQ(valueOf(cloud, 1, "y"), 5);
  EXPECT_EQ(valueOf(cloud, 0, "z"), 3);
  EXPECT_EQ(defect("FIELDS x\nSIZE 4\nTYPE FF\nPOINTS 1\nDATA ascii\n1\n"),
            "line 3 has the type 'FF', which must be F, I or U");
}

TEST(Pcd, RefusesAViewpointThatIsNotFinite)
{
  const auto with = [](const std::string& viewpoint) {
    std::string file = xyzHeader(1, "ascii") + "1 2 3\n";
    const std::string line = "VIEWPOINT 0 0 0 1 0 0 0";
    return file.replace(file.find(line), line.size(), "VIEWPOINT " + viewpoint);
  };
  for (const char* endless : {"nan 2 3 1 0 0 0", "1 inf 3 1 0 0 0", "1 2 3 nan 0 0 0", "1 2 3 1 0 0 -inf"})
    EXPECT_EQ(defect(with(endless)), "has a VIEWPOINT that is not finite") << endless;
  Viewpoint viewpoint;
  parsePcd(with("1 2 3 0 0 0 0"), viewpoint);
  EXPECT_EQ(viewpoint, (Viewpoint{1, 2, 3, 0, 0, 0, 0})) << "which says where, and not how it is turned";
}

TEST(Pcd, TakesWhatProgramsWriteForNaNAsNaN)
{
  for (const std::string nan : {"1.#QNAN", "-1.#IND", "1.#SNAN0", "nan(ind)"}) {
    const pcl::PCLPointCloud2 cloud = parse(xyzHeader(2, "ascii") + "5 6 " + nan + "\n7 8 9 # seen\n");
    EXPECT_EQ(valueOf(cloud, 0, "y"), 6) << nan;
    EXPECT_TRUE(std::isnan(valueOf(cloud, 0, "z"))) << nan;
    EXPECT_EQ(valueOf(cloud, 1, "z"), 9) << nan;
    EXPECT_EQ(defect(header("x y z ring", "4 4 4 1", "F F F U", 1, "ascii") + "1 2 3 " + nan + "\n"),
              "line 11 is damaged: '" + nan + "' is not a whole number in the range of its type");
  }
  EXPECT_EQ(valueOf(parse(xyzHeader(1, "ascii") + "5 6 -1.#INF\n"), 0, "z"), -std::numeric_limits<double>::infinity());
}

/// As PCL writes padding that takes no room.
TEST(Pcd, PaddingMayHaveNoCount)
{
  const auto counted = [](const std::string& counts, const std::string& storage) {
    std::string text = header("x y z _ ring _", "4 4 4 1 2 1", "F F F U U U", 1, storage);
    text.insert(text.find("WIDTH"), "COUNT " + counts + "\n");
    return text;
  };
  const float place[] = {1, 2, 3};
  const std::string xyz(reinterpret_cast<const char*>(place), sizeof place);
  const std::string ring("\7\1", 2);
  const std::pair<std::string, std::string> files[] = {{counted("1 1 1 0 1 0", "ascii"), "1 2 3 263\n"},
                                                       {counted("1 1 1 2 1 0", "ascii"), "1 2 3 9 9 263\n"},
                                                       {counted("1 1 1 0 1 0", "binary"), xyz + ring},
                                                       {counted("1 1 1 4 1 2", "binary"), xyz + "xxxx" + ring + "yy"}};
  for (const auto& [head, body] : files) {
    const pcl::PCLPointCloud2 cloud = parse(head + body);
    EXPECT_EQ(namesOf(cloud), "x y z ring") << head;
    EXPECT_EQ(valueOf(cloud, 0, "z"), 3) << head;
    EXPECT_EQ(valueOf(cloud, 0, "ring"), 263) << head;
  }
  EXPECT_EQ(defect(counted("1 1 1 1 0 1", "ascii") + "1 2 3\n"),
            "field 'ring' has type U, size 2 and count 0, which is no PCD field");
}

} // namespace pcl_bsh::io
