// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"
#include "support/e57_sample.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/e57/reader.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace pcl_bsh::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Value = E57SampleValue;

struct ReadE57 {
  pcl::PCLPointCloud2 cloud;
  CloudFacts facts;
};

ReadE57 readE57(std::string_view file, std::optional<std::size_t> scan = {}, bool beams = false)
{
  E57Reader reader(std::make_unique<HeldBytes>(file), scan, beams);
  return {reader.readAll(), reader.facts()};
}

/// Three Cartesian points, to which more may be added.
E57SampleScan threePoints()
{
  return E57Sample::points({1, 2, 3}, {4, 5, 6}, {7, 8, 9});
}

E57Sample sampleOf(const E57SampleScan& scan)
{
  return {{scan}};
}

std::string defectOfE57(const std::string& file, std::optional<std::size_t> scan = {})
{
  return defectOf([&] { readE57(file, scan); });
}

TEST(E57, ChecksumIsThatOfCastagnoli)
{
  const std::string digits = "123456789";
  EXPECT_EQ(crc32c(reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()), 0xe3069283U);
  std::string bytes(100, '\0');
  std::mt19937 random(5);
  for (char& byte : bytes) byte = static_cast<char>(random());
  for (std::size_t size = 0; size <= bytes.size(); ++size)
    EXPECT_EQ(crc32c(reinterpret_cast<const std::uint8_t*>(bytes.data()), size),
              E57Sample::checksum(bytes.substr(0, size)))
        << size;
}

TEST(E57, IntegersOfEveryWidth)
{
  std::mt19937_64 random(3);
  for (unsigned width = 0; width <= 64; ++width) {
    const std::uint64_t range = width == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << width) - 1;
    const std::int64_t least = width == 64 ? std::numeric_limits<std::int64_t>::min() : width == 63 ? -5 : -7;
    const auto most = static_cast<std::int64_t>(static_cast<std::uint64_t>(least) + range);
    std::vector<std::int64_t> values;
    for (std::size_t i = 0; i < 500; ++i)
      values.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(least) + (random() & range)));
    values[0] = least;
    values[1] = most;
    const std::vector<double> zeros(values.size());
    for (const std::size_t piece : {1u, 7u, 64u, 3000u}) {
      E57SampleScan scan = E57Sample::points(zeros, zeros, zeros);
      scan.values.insert(scan.values.begin(), Value::integer("whole", least, most, values));
      scan.values.push_back(Value::scaled("cut", least, most, "0.5", "3", values));
      scan.piece = piece;
      scan.other_packets = piece == 64;
      const pcl::PCLPointCloud2 cloud = readE57(sampleOf(scan).text()).cloud;
      ASSERT_EQ(cloud.width, values.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(valueOf(cloud, i, "cut"), static_cast<double>(values[i]) * 0.5 + 3) << width << ' ' << i;
        if (width < 53) {
          ASSERT_EQ(valueOf(cloud, i, "whole"), static_cast<double>(values[i])) << width << ' ' << i << ' ' << piece;
        }
        else {
          std::int64_t whole;
          ASSERT_EQ(namesOf(cloud), "x y z whole cut");
          std::memcpy(&whole, &cloud.data[i * cloud.point_step + 24], sizeof whole);
          ASSERT_EQ(whole, values[i]) << width << ' ' << i;
        }
      }
    }
  }
}

TEST(E57, FieldsHaveTheLeastTypeThatHoldsThem)
{
  using Limits = std::numeric_limits<std::int64_t>;
  const auto typeOf = [](std::int64_t least, std::int64_t most) {
    E57SampleScan scan = threePoints();
    scan.values.push_back(Value::integer("n", least, most, {least, most, least}));
    const pcl::PCLPointCloud2 cloud = readE57(sampleOf(scan).text()).cloud;
    return cloud.fields[3].datatype;
  };
  EXPECT_EQ(typeOf(0, 255), Field::UINT8);
  EXPECT_EQ(typeOf(-128, 127), Field::INT8);
  EXPECT_EQ(typeOf(0, 256), Field::UINT16);
  EXPECT_EQ(typeOf(-1, 128), Field::INT16);
  EXPECT_EQ(typeOf(0, 65536), Field::UINT32);
  EXPECT_EQ(typeOf(-1, 32768), Field::INT32);
  EXPECT_EQ(typeOf(-1, 4294967295), Field::INT64);
  EXPECT_EQ(typeOf(Limits::min(), Limits::max()), Field::INT64);
}

/// State 1: a direction in the common frame. Its range is of no meaning, and may be anything.
TEST(E57, BeamsWithoutAReturnHaveADirection)
{
  constexpr double quarter = std::numbers::pi / 2, nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::int64_t> states = {0, 1, 2, 1, 1};
  E57SampleScan spherical, cartesian;
  spherical.values = {Value::doubles("sphericalRange", {2, 0, 3, nan, -7}),
                      Value::doubles("sphericalAzimuth", {0, 0, 0, quarter, 0}),
                      Value::doubles("sphericalElevation", {0, 0, 0, 0, quarter}),
                      Value::integer("sphericalInvalidState", 0, 2, states)};
  cartesian.values = {Value::doubles("cartesianX", {2, 5, 3, 0, 0}), Value::doubles("cartesianY", {0, 0, 0, 1e-300, 0}),
                      Value::doubles("cartesianZ", {0, 0, 0, 0, 1e300}),
                      Value::integer("cartesianInvalidState", 0, 2, states)};
  const std::string turn = E57SampleScan::pose("0.7071067811865476 0 0 0.7071067811865476", "100 0 0");
  for (E57SampleScan scan : {spherical, cartesian})
    for (const bool is_turned : {false, true}) {
      if (is_turned) scan.more_xml = turn;
      const pcl::PCLPointCloud2 cloud = readE57(sampleOf(scan).text(), {}, true).cloud;
      const std::array<std::array<double, 3>, 5> expected = {{{},
                                                              {is_turned ? 0.0 : 1.0, is_turned ? 1.0 : 0.0, 0},
                                                              {},
                                                              {is_turned ? -1.0 : 0.0, is_turned ? 0.0 : 1.0, 0},
                                                              {0, 0, 1}}};
      for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(std::isnan(valueOf(cloud, i, "x")), i != 0);
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(valueOf(cloud, i, std::string(beam_field_names[k])), expected[i][k], 1e-7) << i << ' ' << k;
      }
    }
  cartesian.values[0] = Value::doubles("cartesianX", {2, 0, 3, nan, 1});
  const pcl::PCLPointCloud2 none = readE57(sampleOf(cartesian).text(), {}, true).cloud;
  for (const std::size_t i : {1u, 3u}) EXPECT_EQ(valueOf(none, i, "beam_x"), 0) << "no direction";
  EXPECT_EQ(namesOf(none), "x y z beam_x beam_y beam_z cartesianInvalidState");
  EXPECT_EQ(namesOf(readE57(sampleOf(cartesian).text()).cloud), "x y z cartesianInvalidState");
}

TEST(E57, SphericalPointsBecomeCartesian)
{
  constexpr double half_turn = std::numbers::pi;
  E57SampleScan scan;
  scan.values = {Value::doubles("sphericalRange", {2, 3, 4, 5}),
                 Value::doubles("sphericalAzimuth", {0, half_turn / 2, 1, 1}),
                 Value::doubles("sphericalElevation", {0, half_turn / 6, -0.5, 0}),
                 Value::integer("sphericalInvalidState", 0, 2, {0, 0, 1, 2})};
  const ReadE57 read = readE57(sampleOf(scan).text());
  EXPECT_EQ(namesOf(read.cloud), "x y z sphericalInvalidState");
  EXPECT_EQ(valueOf(read.cloud, 0, "x"), 2);
  EXPECT_NEAR(valueOf(read.cloud, 1, "x"), 0, 1e-15);
  EXPECT_NEAR(valueOf(read.cloud, 1, "y"), 3 * std::sqrt(0.75), 1e-15);
  EXPECT_NEAR(valueOf(read.cloud, 1, "z"), 1.5, 1e-15);
  for (const std::size_t i : {2u, 3u})
    for (const char* axis : {"x", "y", "z"}) EXPECT_TRUE(std::isnan(valueOf(read.cloud, i, axis))) << i;
  EXPECT_EQ(valueOf(read.cloud, 3, "sphericalInvalidState"), 2);
  EXPECT_EQ(originsOf(read.cloud, read.facts).text(), "0,0,0") << "angles are seen from the scanner";
}

/// As the standard has it: a point with a direction alone, and none at all.
TEST(E57, InvalidPointsAreNone)
{
  E57SampleScan scan = threePoints();
  scan.values.push_back(Value::integer("cartesianInvalidState", 0, 2, {1, 0, 2}));
  const pcl::PCLPointCloud2 cloud = readE57(sampleOf(scan).text()).cloud;
  EXPECT_TRUE(std::isnan(valueOf(cloud, 0, "x")));
  EXPECT_EQ(valueOf(cloud, 1, "y"), 5);
  EXPECT_TRUE(std::isnan(valueOf(cloud, 2, "z")));
}

TEST(E57, PosesMoveAndTurn)
{
  E57SampleScan scan = threePoints();
  for (const char* axis : {"nor:normalX", "nor:normalY", "nor:normalZ"})
    scan.values.push_back(
        Value::floats(axis, axis[10] == 'X' ? std::vector<float>{1, 1, 1} : std::vector<float>{0, 0, 0}));
  scan.more_xml = E57SampleScan::pose("0.5 0.5 0.5 0.5", "10 20 30"); // x to y, y to z, z to x
  const ReadE57 read = readE57(sampleOf(scan).text());
  EXPECT_EQ(namesOf(read.cloud), "x y z normal_x normal_y normal_z");
  EXPECT_EQ(valueOf(read.cloud, 0, "x"), 17);
  EXPECT_EQ(valueOf(read.cloud, 0, "y"), 21);
  EXPECT_EQ(valueOf(read.cloud, 0, "z"), 34);
  EXPECT_EQ(valueOf(read.cloud, 2, "normal_x"), 0);
  EXPECT_EQ(valueOf(read.cloud, 2, "normal_y"), 1);
  EXPECT_EQ(read.facts.viewpoint, (Viewpoint{10, 20, 30, 0.5, 0.5, 0.5, 0.5}));
  EXPECT_EQ(originsOf(read.cloud, read.facts).text(), "10,20,30");
  scan.more_xml = E57SampleScan::pose("", "10 20 30");
  EXPECT_EQ(valueOf(readE57(sampleOf(scan).text()).cloud, 1, "x"), 12);
  scan.more_xml = "";
  const ReadE57 without = readE57(sampleOf(scan).text());
  EXPECT_TRUE(originsOf(without.cloud, without.facts).empty()) << "it may be merged of several";
  for (const char* turn : {"0 0 0 0", "2 0 0 0", "nan 0 0 0"}) {
    scan.more_xml = E57SampleScan::pose(turn, "");
    EXPECT_THAT(defectOfE57(sampleOf(scan).text()), HasSubstr("scan 0 has a pose whose quaternion has a length of "));
  }
  scan.more_xml = E57SampleScan::pose("", "1 1e999 2");
  EXPECT_THAT(defectOfE57(sampleOf(scan).text()), HasSubstr("scan 0 has XML with '1e999' in place of a number"));
}

E57Sample threeScans()
{
  E57SampleScan first = threePoints(), second = threePoints(), third = threePoints();
  first.more_xml = E57SampleScan::pose("1 0 0 0", "0 0 100");
  second.more_xml = E57SampleScan::pose("1 0 0 0", "0 0 200");
  third.more_xml = E57SampleScan::pose("1 0 0 0", "0 0 300");
  first.values.push_back(Value::integer("intensity", 0, 200, {7, 8, 9}));
  second.values.push_back(Value::integer("intensity", -9, 0, {-1, -2, -3}));
  second.values.push_back(Value::floats("weight", {0.5, 1.5, 2.5}));
  third.values.insert(third.values.begin(), Value::integer("rowIndex", 0, 1023, {1, 2, 1023}));
  return {{first, second, third}};
}

TEST(E57, SeveralScansAreOneCloud)
{
  const std::string file = threeScans().text();
  const ReadE57 read = readE57(file);
  EXPECT_EQ(namesOf(read.cloud), "x y z intensity weight rowIndex scan");
  EXPECT_EQ(read.cloud.width, 9U);
  EXPECT_EQ(read.cloud.fields[3].datatype, Field::INT16) << "which holds both";
  EXPECT_EQ(valueOf(read.cloud, 1, "intensity"), 8);
  EXPECT_EQ(valueOf(read.cloud, 4, "intensity"), -2);
  EXPECT_EQ(valueOf(read.cloud, 7, "intensity"), 0) << "which has none";
  EXPECT_TRUE(std::isnan(valueOf(read.cloud, 0, "weight")));
  EXPECT_EQ(valueOf(read.cloud, 3, "weight"), 0.5);
  EXPECT_EQ(valueOf(read.cloud, 8, "rowIndex"), 1023);
  EXPECT_EQ(valueOf(read.cloud, 0, "z"), 107);
  EXPECT_EQ(valueOf(read.cloud, 8, "z"), 309);
  EXPECT_EQ(valueOf(read.cloud, 2, "scan"), 0);
  EXPECT_EQ(valueOf(read.cloud, 3, "scan"), 1);
  EXPECT_EQ(originsOf(read.cloud, read.facts).text(), "scan:0=0,0,100;1=0,0,200;2=0,0,300");

  const ReadE57 second = readE57(file, 1);
  EXPECT_EQ(namesOf(second.cloud), "x y z intensity weight");
  EXPECT_EQ(second.cloud.width, 3U);
  EXPECT_EQ(valueOf(second.cloud, 2, "z"), 209);
  EXPECT_EQ(originsOf(second.cloud, second.facts).text(), "0,0,200");
  EXPECT_EQ(defectOfE57(file, 3), "has 3 scans, and no scan 3");
}

TEST(E57, ColoursArePacked)
{
  const auto scanOf = [](std::int64_t most, const std::vector<std::int64_t>& red) {
    E57SampleScan scan = threePoints();
    scan.values.push_back(Value::integer("colorRed", 0, most, red));
    scan.values.push_back(Value::integer("colorGreen", 0, most, {0, 0, most}));
    scan.values.push_back(Value::integer("colorBlue", 0, most, {most, 0, 0}));
    return scan;
  };
  E57SampleScan scan = scanOf(255, {1, 128, 255});
  const std::string limits = "<colorLimits><colorRedMinimum>0</colorRedMinimum><colorRedMaximum>1000</colorRedMaximum>"
                             "</colorLimits>";
  scan.more_xml = limits;
  pcl::PCLPointCloud2 cloud = readE57(sampleOf(scan).text()).cloud;
  EXPECT_EQ(namesOf(cloud), "x y z rgb");
  EXPECT_EQ(colourOf(cloud, 0), 0x0100ffU);
  EXPECT_EQ(colourOf(cloud, 1), 0x800000U) << "a byte is what it is, whatever limits say";
  EXPECT_EQ(colourOf(cloud, 2), 0xffff00U);

  scan = scanOf(65535, {257, 1000, 65535});
  cloud = readE57(sampleOf(scan).text()).cloud;
  EXPECT_EQ(namesOf(cloud), "x y z rgb red green blue");
  EXPECT_EQ(colourOf(cloud, 0), 0x0100ffU);
  EXPECT_EQ(valueOf(cloud, 1, "red"), 1000);
  scan.more_xml = limits;
  cloud = readE57(sampleOf(scan).text()).cloud;
  EXPECT_EQ(colourOf(cloud, 1), 0xff0000U);
  EXPECT_EQ(colourOf(cloud, 2), 0xffff00U) << "beyond the limits";
  EXPECT_EQ(cloud.fields[4].datatype, Field::UINT16);
  scan.values.pop_back();
  EXPECT_EQ(namesOf(readE57(sampleOf(scan).text()).cloud), "x y z colorRed colorGreen") << "without blue, no colour";
}

TEST(E57, OtherValuesKeepTheirNames)
{
  E57SampleScan scan = threePoints();
  scan.values.push_back(Value::integer("ext:classification", 0, 31, {1, 2, 3}));
  scan.values.push_back({"<note type=\"String\"/>", 0, {}, "\2a\2b\2c"});
  scan.values.push_back(Value::doubles("timeStamp", {0.5, 1.5, 2.5}));
  scan.values.push_back(Value::integer("x", 0, 31, {1, 2, 3}));
  const ReadE57 read = readE57(sampleOf(scan).text());
  EXPECT_EQ(namesOf(read.cloud), "x y z ext_classification timeStamp x_2");
  EXPECT_EQ(valueOf(read.cloud, 2, "timeStamp"), 2.5);
  EXPECT_EQ(valueOf(read.cloud, 2, "x_2"), 3);
  EXPECT_THAT(read.facts.remarks, testing::ElementsAre("its points have texts, which are not read: 'note'"));
}

TEST(E57, TheCoordinateSystemIsNamed)
{
  E57Sample sample = sampleOf(threePoints());
  sample.more_xml =
      "<coordinateMetadata type=\"String\"><![CDATA[PROJCS[\"UTM 32N\", GEOGCS[]]]]></coordinateMetadata>";
  EXPECT_EQ(readE57(sample.text()).facts.coordinate_system.name, "UTM 32N");
}

TEST(E57, ReadInBatchesItIsTheSame)
{
  const TemporaryFolder folder;
  std::vector<double> numbers(10000);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  E57Sample sample = threeScans();
  sample.scans.push_back(E57Sample::points(numbers, numbers, numbers));
  sample.page = 64;
  const fs::path file = folder.write("a.e57", sample.text());
  const pcl::PCLPointCloud2 cloud = readCloud(file);
  EXPECT_EQ(cloud.width, 10009U);
  EXPECT_FALSE(cloud.is_dense) << "weights of other scans";
  const auto stream = openCloud(file, 1 << 20);
  EXPECT_EQ(stream->size(), 10009U);
  std::vector<std::uint8_t> records, batch(777 * cloud.point_step);
  while (const std::size_t points = stream->read(batch.data(), 777))
    records.insert(records.end(), batch.begin(),
                   batch.begin() + static_cast<std::ptrdiff_t>(points * cloud.point_step));
  EXPECT_EQ(records, cloud.data);
  EXPECT_EQ(readCloudHeader(file).width, 10009U);
  EXPECT_EQ(readCloud(file, nullptr, {{}, false, 2}).width, 3U);
  EXPECT_THROW(readCloud(file, nullptr, {{}, false, 9}), files::FileError);
}

TEST(E57, WithoutScansOrPointsItIsEmpty)
{
  EXPECT_EQ(readE57(E57Sample().text()).cloud.width, 0U);
  EXPECT_EQ(namesOf(readE57(E57Sample().text()).cloud), "x y z");
  EXPECT_EQ(readE57(sampleOf(E57SampleScan()).text()).cloud.width, 0U);
  EXPECT_EQ(defectOfE57(E57Sample().text(), 0), "has 0 scans, and no scan 0");
}

TEST(E57, CutAnywhereItIsRefused)
{
  const std::string file = threeScans().text();
  for (std::size_t size = 0; size < file.size(); size += 13) EXPECT_NE(defectOfE57(file.substr(0, size)), "") << size;
  for (std::size_t at = 48; at < file.size(); at += 101) {
    std::string damaged = file;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    EXPECT_EQ(defectOfE57(damaged),
              "is damaged: page " + std::to_string(at / 1024) + " has another checksum than it says");
  }
}

/// Headers that lie, or ask for memory that the file does not justify.
TEST(E57, RefusesWhatCannotBe)
{
  const auto withRecords = [](const std::string& records) {
    E57SampleScan scan = threePoints();
    scan.records = records;
    return defectOfE57(sampleOf(scan).text());
  };
  EXPECT_EQ(withRecords("4"), "is truncated: a scan's section ends before the last of its points");
  EXPECT_THAT(withRecords("9223372036854775808"), HasSubstr("header promises 9223372036854775808 points, its size"));
  EXPECT_THAT(withRecords("18446744073709551616"), HasSubstr("in place of a number"));
  EXPECT_THAT(withRecords("-1"), HasSubstr("in place of a number"));
  E57SampleScan constant; // which takes no bits
  for (const char* axis : {"cartesianX", "cartesianY", "cartesianZ"})
    constant.values.push_back(Value::integer(axis, 5, 5, {5, 5}));
  EXPECT_EQ(readE57(sampleOf(constant).text()).cloud.width, 2U);
  constant.records = "100000000";
  EXPECT_THAT(defectOfE57(sampleOf(constant).text()), HasSubstr("is truncated: its header promises"));
  E57Sample shared; // each scan fits, all of them do not
  constant.records = "7000";
  shared.scans.assign(3, constant);
  EXPECT_THAT(defectOfE57(shared.text()), HasSubstr("is truncated: its header promises"));

  const auto withValue = [](const Value& value) {
    E57SampleScan scan = threePoints();
    scan.values.push_back(value);
    return defectOfE57(sampleOf(scan).text());
  };
  Value above = Value::integer("n", 1, 5, {1, 2, 3});
  above.stored[1] = 7;
  EXPECT_EQ(withValue(above), "is damaged: a value of 'n' is above its maximum");
  EXPECT_EQ(withValue({"<n type=\"Integer\" minimum=\"3\" maximum=\"2\"/>", 0, {}}),
            "scan 0 has 'n' with a maximum below its minimum");
  EXPECT_EQ(withValue({"<n type=\"ScaledInteger\" scale=\"inf\"/>", 0, {}}),
            "scan 0 has 'n' with a scale or an offset that is not finite");
  EXPECT_EQ(withValue({"<n type=\"Structure\"/>", 0, {}}), "scan 0 has points with 'n', which is no number");
  EXPECT_EQ(withValue(Value::doubles("cartesianX", {1, 2, 3})), "scan 0 has points with two values 'cartesianX'");
  E57SampleScan flat = threePoints();
  flat.values.pop_back();
  EXPECT_THAT(defectOfE57(sampleOf(flat).text()), HasSubstr("scan 0 has points with neither cartesianX"));
  E57SampleScan wide = threePoints();
  for (int i = 0; i < 300; ++i) wide.values.push_back(Value::integer("n" + std::to_string(i), 0, 0, {0, 0, 0}));
  EXPECT_EQ(defectOfE57(sampleOf(wide).text()), "scan 0 has points with more than 256 values");
}

TEST(E57, RefusesHeadersThatLie)
{
  const E57Sample sample = sampleOf(threePoints());
  const std::string logical = sample.logical();
  const auto with = [&](std::size_t at, std::uint64_t number) {
    std::string content = logical;
    std::memcpy(&content[at], &number, sizeof number);
    return defectOfE57(sample.paged(content));
  };
  EXPECT_THAT(with(0, 1), HasSubstr("is not an E57 file"));
  EXPECT_EQ(with(8, 2), "is of version 2 of E57");
  EXPECT_THAT(with(16, 1 << 20), HasSubstr("is truncated: its header promises 1048576 bytes"));
  EXPECT_THAT(with(24, 1 << 20), HasSubstr("points to byte 1048576, where it has no content"));
  EXPECT_THAT(with(24, 1022), HasSubstr("points to byte 1022, where it has no content"));
  EXPECT_NE(with(24, 0), "") << "the header is no XML";
  EXPECT_EQ(with(32, 5000), "is truncated: it ends within its XML");
  EXPECT_THAT(with(32, ~std::uint64_t{0}), HasSubstr("says that its XML has 18446744073709551615 bytes"));
  for (const std::uint64_t page : {std::uint64_t{0}, std::uint64_t{1022}, ~std::uint64_t{0}})
    EXPECT_THAT(with(40, page), HasSubstr("bytes, which E57 has not"));
  EXPECT_NE(with(40, 512), "");
  EXPECT_NE(with(48, 0), "") << "no section of points";
  EXPECT_THAT(with(56, 40), HasSubstr("is damaged: a scan has a packet of no known kind"));
  EXPECT_EQ(with(56, 34), "is truncated: a scan's section ends before the last of its points");
  EXPECT_NE(with(64, 48), "") << "packets that begin at the section's own head";
  EXPECT_NE(with(64, 1020), "");
  EXPECT_NE(with(80, ~std::uint64_t{0}), "") << "a packet of no kind";
  EXPECT_THAT(with(80, 0x0004005b0001), HasSubstr("is damaged: ")) << "another number of streams";
}

TEST(E57, RefusesXmlThatIsABomb)
{
  const E57Sample sample = sampleOf(threePoints());
  const auto fileOf = [&](const std::string& xml) { return sample.paged(sample.withXml(std::string(48, '\0'), xml)); };
  const auto withXml = [&](const std::string& xml) { return defectOfE57(fileOf(xml)); };
  EXPECT_THAT(withXml(""), HasSubstr("has XML that cannot be read"));
  EXPECT_THAT(withXml("<a/>"), HasSubstr("there is no e57Root"));
  std::string deep;
  for (int i = 0; i < 300000; ++i) deep += "<a>";
  EXPECT_THAT(withXml(deep), HasSubstr("has XML that cannot be read"));
  std::string closed = "<e57Root>" + deep;
  for (int i = 0; i < 300000; ++i) closed += "</a>";
  EXPECT_EQ(readE57(fileOf(closed + "</e57Root>")).cloud.width, 0U);
  std::string laughs = "<!DOCTYPE e57Root [<!ENTITY a \"ha\">";
  for (char c = 'b'; c <= 'z'; ++c) {
    laughs += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) laughs += std::string("&") + static_cast<char>(c - 1) + ";";
    laughs += "\">";
  }
  const std::string told = "]><e57Root><coordinateMetadata>\"&z;\"</coordinateMetadata></e57Root>";
  EXPECT_EQ(readE57(fileOf(laughs + told)).facts.coordinate_system.name, "&z;") << "which is not followed";
}

/// Up to four bytes of the content changed, and checksums made anew, which would refuse them all.
TEST(E57, DamagedContentIsReadOrRefused)
{
  E57Sample sample = threeScans();
  sample.scans[0].other_packets = true;
  sample.page = 64;
  const std::string sound = sample.logical();
  std::mt19937 random(11);
  std::size_t read = 0, refused = 0;
  for (std::size_t round = 0; round < 3000; ++round) {
    std::string content = sound;
    for (std::size_t hits = 1 + random() % 4; hits > 0; --hits)
      content[random() % content.size()] =
          random() % 2 ? static_cast<char>(random()) : "0123456789-.e<>/\" "[random() % 18];
    const std::string file = sample.paged(content);
    try {
      EXPECT_LE(readE57(file).cloud.data.size(), 512 * file.size());
      ++read;
    }
    catch (const FormatError&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 100U);
  EXPECT_GT(refused, 100U);
}

class E57Files : public testing::Test {
protected:
  void SetUp() override
  {
    if (!fs::exists(samples)) GTEST_SKIP() << "no " << samples;
  }
  const fs::path samples = fs::path(PCL_BSH_SHARED_DIR) / "data/formats/e57";
};

TEST_F(E57Files, OneCloudInFourTypes)
{
  const pcl::PCLPointCloud2 exact = readCloud(samples / "bunnyDouble.e57");
  ASSERT_EQ(exact.width, 30571U);
  EXPECT_TRUE(exact.is_dense);
  for (const char* name : {"bunnyFloat.e57", "bunnyInt19.e57", "bunnyInt32.e57"}) {
    const pcl::PCLPointCloud2 cloud = readCloud(samples / name);
    ASSERT_EQ(cloud.width, exact.width) << name;
    for (std::size_t i = 0; i < exact.width; ++i)
      for (const char* axis : {"x", "y", "z"})
        ASSERT_NEAR(valueOf(cloud, i, axis), valueOf(exact, i, axis), 1e-6) << name << ' ' << i;
  }
  double least = 1, greatest = -1;
  for (std::size_t i = 0; i < exact.width; ++i) {
    least = std::min(least, valueOf(exact, i, "x"));
    greatest = std::max(greatest, valueOf(exact, i, "x"));
  }
  EXPECT_DOUBLE_EQ(least, -0.094689) << "as the file's bounds say";
  EXPECT_DOUBLE_EQ(greatest, 0.061009);
}

TEST_F(E57Files, OfOtherPrograms)
{
  const auto fieldsOf = [&](const char* name) { return namesOf(readCloud(samples / name)); };
  const pcl::PCLPointCloud2 colours = readCloud(samples / "tinyCartesianFloatRgb.e57");
  EXPECT_EQ(namesOf(colours), "x y z rgb");
  EXPECT_EQ(colours.width, 2090U);
  EXPECT_EQ(fieldsOf("tiny_pc_with_extension.e57"), "x y z normal_x normal_y normal_z");
  EXPECT_EQ(fieldsOf("no_ext_namespace.e57"), "x y z classification");
  EXPECT_EQ(fieldsOf("integer_intensity.e57"), "x y z intensity cartesianInvalidState");
  EXPECT_EQ(fieldsOf("float_intensity_without_min_max.e57"), "x y z intensity");
  EXPECT_EQ(readCloud(samples / "empty.e57").width, 0U);
  EXPECT_EQ(readCloud(samples / "empty_pc.e57").width, 0U);
  EXPECT_EQ(readCloud(samples / "tiny_pc_and_images.e57").width, 2U);
  EXPECT_EQ(valueOf(readCloud(samples / "integer_intensity.e57"), 0, "intensity"), -66);
  CloudFacts facts;
  const pcl::PCLPointCloud2 moved = readCloud(samples / "translationWithoutRotation.e57", &facts);
  EXPECT_EQ(valueOf(moved, 0, "x"), 4);
  EXPECT_EQ(valueOf(moved, 0, "z"), 6);
  EXPECT_EQ(originsOf(moved, facts).text(), "4,5,6");
  const pcl::PCLPointCloud2 states = readCloud(samples / "cartesian_invalid_state_single.e57");
  ASSERT_EQ(states.width, 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(std::isnan(valueOf(states, i, "x")), valueOf(states, i, "cartesianInvalidState") != 0) << i;
  EXPECT_THAT([&] { readCloud(samples / "corrupt_crc.e57"); },
              testing::ThrowsMessage<files::FileError>(HasSubstr("has another checksum than it says: export or copy")));
}

} // namespace
} // namespace pcl_bsh::io
