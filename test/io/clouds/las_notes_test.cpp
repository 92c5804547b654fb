// SPDX-License-Identifier: BSD-3-Clause
#include "las_sample.h"
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/las/notes.h>
#include <pcl_bsh/io/clouds/las/reader.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

namespace fs = std::filesystem;

std::string systemOf(const LasSample& sample)
{
  return coordinateSystemOf(LasReader(std::make_unique<HeldBytes>(sample.text())).lasHeader());
}

/// A directory of GeoTIFF's keys: key, place of its value, count, value.
std::string keys(const std::vector<std::array<std::uint16_t, 4>>& entries)
{
  std::string bytes(8, '\0');
  put(bytes, 0, std::uint16_t{1});
  put(bytes, 6, static_cast<std::uint16_t>(entries.size()));
  for (const auto& entry : entries)
    for (const std::uint16_t number : entry) put(bytes, bytes.size(), number);
  return LasSample::record("LASF_Projection", 34735, bytes);
}

std::string texts(const std::string& content)
{
  return LasSample::record("LASF_Projection", 34737, content);
}

constexpr auto wkt = "COMPD_CS[\"NAD83 / UTM zone 15N + NAVD88\",PROJCS[\"NAD83 / UTM zone 15N\"]]";

TEST(LasNotes, CoordinateSystemOfWkt)
{
  LasSample sample(4, 6);
  sample.addPoints(3);
  EXPECT_EQ(systemOf(sample), "");
  const std::string record = LasSample::record("LASF_Projection", 2112, wkt);
  sample.records = {LasSample::record("LASF_Projection", 2111, "no"), record};
  EXPECT_EQ(systemOf(sample), "NAD83 / UTM zone 15N + NAVD88");
  sample.records = {};
  sample.extended = {LasSample::extendedRecord("somebody", 2112, "PROJCS[\"other\"]"),
                     LasSample::extendedRecord("LASF_Projection", 2112, wkt)};
  EXPECT_EQ(systemOf(sample), "NAD83 / UTM zone 15N + NAVD88") << "behind the points";
  sample.extended = {};
  for (const char* damaged : {"PROJCS[...]", "PROJCS[\"endless", "\"", ""}) {
    sample.records = {LasSample::record("LASF_Projection", 2112, damaged)};
    EXPECT_EQ(systemOf(sample), "") << damaged;
  }
  sample.records = {LasSample::record("LASF_Projection", 2112, "PROJCS[\"a\nb\xc3\xa4\"]")};
  EXPECT_EQ(systemOf(sample), "a b??") << "as it may stand in a report";
}

TEST(LasNotes, CoordinateSystemOfGeoTiff)
{
  LasSample sample(2, 1);
  sample.addPoints(3);
  const std::array<std::uint16_t, 4> citation = {1026, 34737, 13, 0}, code = {3072, 0, 1, 26915};
  sample.records = {keys({{1024, 0, 1, 1}, citation}), texts("UTM Zone 15N|another")};
  EXPECT_EQ(systemOf(sample), "UTM Zone 15N");
  sample.records = {keys({citation, {2048, 0, 1, 4269}, code}), texts("UTM Zone 15N|another")};
  EXPECT_EQ(systemOf(sample), "UTM Zone 15N (EPSG:26915)");
  sample.records = {keys({{1024, 0, 1, 1}, citation, {2048, 0, 1, 4269}}), texts("UTM Zone 15N|another")};
  EXPECT_EQ(systemOf(sample), "UTM Zone 15N") << "the code is that of angles";
  sample.records = {keys({{1024, 0, 1, 2}, citation, {2048, 0, 1, 4269}}), texts("UTM Zone 15N|another")};
  EXPECT_EQ(systemOf(sample), "UTM Zone 15N (EPSG:4269)");
  sample.records = {keys({code, {4096, 0, 1, 5703}})};
  EXPECT_EQ(systemOf(sample), "EPSG:26915 + EPSG:5703");
  sample.records = {keys({{3072, 0, 1, 32767}, {3073, 34737, 9, 900}})};
  EXPECT_EQ(systemOf(sample), "") << "a code of the user's own, and a citation that is not there";
  sample.records = {keys({code}).substr(0, 54 + 8 + 5)};
  put(sample.records[0], 20, std::uint16_t{8 + 5});
  EXPECT_EQ(systemOf(sample), "");
}

TEST(LasNotes, TheHeaderChoosesBetweenTwo)
{
  LasSample sample(4, 6);
  sample.addPoints(3);
  sample.records = {keys({{3072, 0, 1, 26915}}), LasSample::record("LASF_Projection", 2112, wkt)};
  EXPECT_EQ(systemOf(sample), "EPSG:26915");
  sample.global_encoding = 16;
  EXPECT_EQ(systemOf(sample), "NAD83 / UTM zone 15N + NAVD88");
}

TEST(LasNotes, RecordsThatTheHeaderDoesNotCount)
{
  const TemporaryFolder folder;
  const auto remarksOf = [&](const std::string& file) {
    const fs::path path = folder.write("a.las", file);
    CloudFacts facts;
    readCloud(path, &facts);
    EXPECT_EQ(openCloud(path, 1 << 20)->facts().remarks, facts.remarks);
    return facts.remarks;
  };
  LasSample sample(2, 1);
  sample.addPoints(5);
  EXPECT_TRUE(remarksOf(sample.text()).empty());
  const std::string more(3 * sample.length(), 'p');
  EXPECT_THAT(remarksOf(sample.text() + more),
              testing::ElementsAre("its header counts 5 of the 8 records there is room for: 3 are left out"));
  EXPECT_THAT(remarksOf(sample.text() + more.substr(0, sample.length() + 1)),
              testing::ElementsAre("its header counts 5 of the 6 records there is room for: 1 is left out"));
  EXPECT_TRUE(remarksOf(sample.text() + more.substr(0, sample.length() - 1)).empty()) << "padding";
  LasSample records(4, 6);
  records.addPoints(5);
  records.extended = {LasSample::extendedRecord("somebody", 9, std::string(1000, 'e'))};
  EXPECT_TRUE(remarksOf(records.text()).empty()) << "records, but no points";
  LasSample waves(3, 4);
  waves.global_encoding = 2;
  waves.addPoints(5);
  EXPECT_TRUE(remarksOf(waves.text() + LasSample::extendedRecord("LASF_Spec", 65535, std::string(1000, 'w'))).empty());
}

TEST(LasNotes, RealFiles)
{
  const fs::path samples = fs::path(PCL_BSH_SHARED_DIR) / "data/formats";
  if (!fs::exists(samples)) GTEST_SKIP() << "no " << samples;
  const auto systemIn = [&](const char* name) {
    CloudFacts facts;
    readCloud(samples / name, &facts);
    return facts.coordinate_system.name;
  };
  EXPECT_EQ(systemIn("simple.las"), "");
  EXPECT_EQ(systemIn("utm15.las"), "UTM Zone 15, Northern Hemisphere (EPSG:26915)");
  EXPECT_EQ(systemIn("no-points.las"), "NAD83 (EPSG:4269)");
  EXPECT_EQ(systemIn("interesting.las"), "NAD_1983_Oregon_Statewide_Lambert_Feet_Intl");
  EXPECT_EQ(systemIn("autzen_trim_7.las"), "NAD_1983_HARN_Lambert_Conformal_Conic");
  EXPECT_EQ(systemIn("test1_4.las"), "NAD83(HARN) / New Mexico Central (ftUS)");
}

/// Control characters between words become blanks.
TEST(LasNotes, NamesAreALineOfAscii)
{
  LasSample sample(4, 6);
  sample.records = {LasSample::record("LASF_Projection", 2112, "PROJCS[\" a\rb\tc\x7f~\x1f \"]")};
  EXPECT_EQ(systemOf(sample), "a b c?~?");
  sample.records = {LasSample::record("LASF_Projection", 2112, "P[\"" + std::string(300, 'n') + "\"]")};
  EXPECT_EQ(systemOf(sample), std::string(200, 'n'));
}

TEST(LasNotes, KeysThatSayNothingAreLeftOut)
{
  LasSample sample(2, 1);
  sample.records = {keys({{3072, 0, 1, 0}, {1026, 34737, 5, 0}}), texts("a UTM|")};
  EXPECT_EQ(systemOf(sample), "a UTM") << "no code is 0";
  sample.records = {keys({{3072, 34737, 1, 26915}, {1026, 34737, 5, 0}}), texts("a UTM|")};
  EXPECT_EQ(systemOf(sample), "a UTM") << "a place in the texts is no code";
  sample.records = {keys({{3073, 34737, 2, 0}, {1026, 34737, 5, 2}}), texts(" |a UTM|")};
  EXPECT_EQ(systemOf(sample), "a UTM") << "the first citation that says something";
  sample.records = {keys({{3073, 34737, 3, 0}, {1026, 34737, 5, 2}}), texts("a UTM|")};
  EXPECT_EQ(systemOf(sample), "a U") << "as long as its key says";
}

/// Which no reader has checked.
TEST(LasNotes, HeadersMayEndTooEarly)
{
  LasSample sample(4, 6);
  sample.extended = {LasSample::extendedRecord("somebody", 9, "more"),
                     LasSample::extendedRecord("LASF_Projection", 2112, wkt)};
  sample.addPoints(2);
  const std::string file = sample.text();
  const LasHeader sound = LasReader(std::make_unique<HeldBytes>(file)).lasHeader();
  ASSERT_EQ(coordinateSystemOf(sound), "NAD83 / UTM zone 15N + NAVD88");
  LasHeader header = sound;
  for (std::size_t left = 0; left < sound.behind_points.size(); left += 3) {
    header.behind_points.resize(left);
    EXPECT_EQ(coordinateSystemOf(header), "") << left;
    header.behind_points = sound.behind_points;
  }
  header.block.extended_at = 7;
  EXPECT_EQ(coordinateSystemOf(header), "");
  header.block.extended_at = ~std::uint64_t{0};
  EXPECT_EQ(coordinateSystemOf(header), "");
}

/// Points of a .laz end where its chunks do: what is behind them is no point.
TEST(LasNotes, OfCompressedPointsThereIsNoRoomForMore)
{
  LasBlock block;
  block.points_at = 375;
  block.record_length = 20;
  EXPECT_EQ(remarksOn(block, 1000).size(), 1U);
  block.compressed = true;
  EXPECT_TRUE(remarksOn(block, 1000).empty());
}

} // namespace
} // namespace pcl_bsh::io
