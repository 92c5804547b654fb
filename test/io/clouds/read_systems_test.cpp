// SPDX-License-Identifier: BSD-3-Clause
// Files that are read in another coordinate system than their own.
#include "coordinate_samples.h"
#include "las_sample.h"
#include "samples.h"
#include "support/e57_sample.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/clouds/las/notes.h>
#include <pcl_bsh/io/clouds/las/reader.h>
#include <pcl_bsh/search/cloud_view.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

using testing::Contains;
using testing::HasSubstr;

ReadSettings systemsOf(const std::string& crs, const std::string& to_crs)
{
  ReadSettings settings;
  settings.crs = crs;
  settings.to_crs = to_crs;
  return settings;
}

/// Points about the middle of zone 33, which is 6 degrees east of that of zone 32.
LasSample lasOfZone33(const std::string& record)
{
  LasSample sample(4, 6);
  sample.scale = {1e-6, 1e-6, 1e-6};
  sample.offset = {500000, 5400000, 100};
  sample.addPoints(7);
  sample.records = {record};
  return sample;
}

std::string wktRecord(const std::string& wkt)
{
  return LasSample::record("LASF_Projection", 2112, wkt);
}

class ReadSystems : public testing::Test {
protected:
  void SetUp() override
  {
    if (!hasProj()) GTEST_SKIP() << "install libproj-dev";
  }

  std::string refusal(const std::filesystem::path& file, const ReadSettings& settings) const
  {
    std::string said;
    for (const bool is_stream : {false, true}) {
      try {
        if (is_stream)
          openCloud(file, std::uint64_t{1} << 30, settings);
        else
          readCloud(file, nullptr, settings);
      }
      catch (const files::FileError& error) {
        said += std::string(is_stream ? "\n" : "") + error.what();
      }
    }
    EXPECT_EQ(said.substr(0, said.find('\n')), said.substr(std::min(said.find('\n') + 1, said.size())));
    return said.substr(0, said.find('\n'));
  }

  TemporaryFolder folder;
};

/// They are not turned, and would point elsewhere.
TEST_F(ReadSystems, AnotherTakesDirectionsOfBeamsAway)
{
  const auto file = folder.write("a.pcd", "FIELDS x y z beam_x beam_y beam_z\nSIZE 8 8 8 4 4 4\nTYPE F F F F F F\n"
                                          "COUNT 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
                                          "500000 5400000 0 0 0 0\nnan nan nan 0.6 0 0.8\n");
  const auto beamIn = [&](const char* to) {
    const pcl::PCLPointCloud2 cloud = readCloud(file, nullptr, systemsOf("EPSG:25832", to));
    return std::pair(valueOf(cloud, 1, "beam_x"), valueOf(cloud, 1, "beam_z"));
  };
  EXPECT_EQ(beamIn("EPSG:25833"), std::pair(0.0, 0.0));
  EXPECT_EQ(beamIn("EPSG:25832"), std::pair(double{0.6f}, double{0.8f})) << "the file's own";
}

TEST_F(ReadSystems, AreOfAllFormatsAndStreams)
{
  const auto las = folder.write("a.las", lasOfZone33(wktRecord(utm_33_wkt)).text());
  const pcl::PCLPointCloud2 plain = readCloud(las);
  std::vector<std::filesystem::path> files = {las};
  for (const char* name : {"a.pcd", "a.ply", "a.xyz"}) {
    files.push_back(folder / name);
    writeCloud(files.back(), plain);
  }
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename());
    const ReadSettings settings = systemsOf(file == las ? "" : "EPSG:25833", "EPSG:25832");
    CloudFacts facts;
    const pcl::PCLPointCloud2 cloud = readCloud(file, &facts, settings);
    for (std::uint32_t i = 0; i < viewOf(plain).count; ++i) {
      const Point3 from = viewOf(readCloud(file)).point(i), to = viewOf(cloud).point(i);
      constexpr double around = 3100; // the points are within 2148 of the middle, along each axis
      EXPECT_NEAR(to[0], 940915, around);
      EXPECT_NEAR(to[1], 5417388, around);
      EXPECT_EQ(to[2], from[2]);
    }
    EXPECT_EQ(facts.coordinate_system.name, "ETRS89 / UTM zone 32N (EPSG:25832)");
    EXPECT_EQ(facts.coordinate_system.definition, "EPSG:25832");
    EXPECT_EQ(facts.unit, LengthUnit::m);
    writeCloud(folder / "b.las", cloud, no_viewpoint, facts.las);
    CloudFacts written;
    EXPECT_EQ(readCloud(folder / "b.las", &written).width, cloud.width);
    EXPECT_EQ(written.coordinate_system.name, "ETRS89 / UTM zone 32N") << "of a record that is new";
    EXPECT_EQ(areOneSystem(written.coordinate_system, {"", "EPSG:25832"}), true);
    EXPECT_EQ(written.unit, LengthUnit::m);
    EXPECT_THAT(facts.remarks, Contains(HasSubstr("'Inverse of UTM zone 33N + UTM zone 32N'")));
    EXPECT_THAT(facts.remarks, Contains(HasSubstr("the grid scale of its middle is ")));
    EXPECT_EQ(readCloudHeader(file, settings).point_step, cloud.point_step);
    const auto stream = openCloud(file, std::uint64_t{1} << 30, settings);
    EXPECT_EQ(stream->facts().unit, LengthUnit::m);
    EXPECT_EQ(stream->facts().coordinate_system.definition, "EPSG:25832");
    EXPECT_EQ(stream->facts().remarks, facts.remarks);
    EXPECT_EQ(stream->header().point_step, cloud.point_step);
    std::vector<std::uint8_t> records(cloud.data.size());
    std::size_t read = 0;
    while (const std::size_t points = stream->read(records.data() + read * cloud.point_step, 2)) read += points;
    EXPECT_EQ(read, stream->size());
    EXPECT_EQ(records, cloud.data);
  }
}

TEST_F(ReadSystems, ScannersMove)
{
  const auto file = folder.write("a.ptx", "1\n1\n500000 5400000 100\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
                                          "500000 5400000 100 1\n1 2 3 0.5\n");
  CloudFacts facts;
  const Point3 point = viewOf(readCloud(file, &facts, systemsOf(utm_33_wkt, "EPSG:25832"))).point(0);
  ASSERT_EQ(facts.scanners.size(), 1U);
  for (const Viewpoint& stood : {facts.viewpoint, facts.scanners[0]}) {
    EXPECT_NEAR(std::hypot(point[0] - stood[0], point[1] - stood[1]), std::sqrt(5.0), 0.01);
    EXPECT_EQ(point[2] - stood[2], 3);
  }
}

/// LAS asks for WKT of version 1, which has places with heights, and no names of all codes.
TEST_F(ReadSystems, AreHandedOverToLas)
{
  const pcl::PCLPointCloud2 cloud = readCloud(folder.write("a.xyz", "x y z\n500000 5400000 100\n"));
  const auto handedOver = [&](const CoordinateSystem& system) {
    LasHeader header;
    header.system = system;
    writeCloud(folder / "a.las", cloud, no_viewpoint, std::make_shared<const LasHeader>(header));
    CloudFacts facts;
    EXPECT_EQ(readCloud(folder / "a.las", &facts).width, 1U);
    return facts;
  };
  for (const std::string text : {"EPSG:25832", "EPSG:25832+7837", "EPSG:4326", "EPSG:2263"}) {
    SCOPED_TRACE(text);
    const CloudFacts facts = handedOver(coordinateSystemNamed(text));
    EXPECT_EQ(areOneSystem(facts.coordinate_system, {"", text}), true);
    EXPECT_THAT(facts.coordinate_system.definition, testing::AnyOf(HasSubstr("PROJCS["), HasSubstr("GEOGCS[")));
  }
  EXPECT_EQ(handedOver(coordinateSystemNamed("EPSG:2263")).unit, LengthUnit::us_ft);
  for (const std::string unknown : {"", "EPSG:0", "LOCAL", "PROJCS["})
    EXPECT_EQ(handedOver({"known by its name", unknown}).coordinate_system.name, "") << unknown;
}

TEST_F(ReadSystems, OfE57ArriveInLas)
{
  E57Sample sample = {{E57Sample::points({500000}, {5400000}, {100})}};
  sample.more_xml =
      "<coordinateMetadata type=\"String\"><![CDATA[" + std::string(utm_33_wkt) + "]]></coordinateMetadata>";
  const auto e57 = folder.write("a.e57", sample.text());
  CloudFacts facts;
  const pcl::PCLPointCloud2 cloud = readCloud(e57, &facts);
  writeCloud(folder / "a.las", cloud, facts.viewpoint, facts.las);
  readCloud(folder / "a.las", &facts);
  EXPECT_EQ(areOneSystem(facts.coordinate_system, {"", "EPSG:25833"}), true) << facts.coordinate_system.definition;
  ReadSettings settings = systemsOf("", "EPSG:25832");
  for (const bool beams : {false, true}) {
    settings.beams = beams;
    readCloud(e57, &facts, settings);
    const auto told = Contains(HasSubstr("beams without a return see nothing"));
    if (beams) {
      EXPECT_THAT(facts.remarks, told);
    }
    else {
      EXPECT_THAT(facts.remarks, testing::Not(told));
    }
  }
}

TEST_F(ReadSystems, OneSystemChangesNothing)
{
  const auto las = folder.write("a.las", lasOfZone33(wktRecord(utm_33_wkt)).text());
  CloudFacts facts;
  EXPECT_EQ(readCloud(las, &facts, systemsOf("", "EPSG:25833")).data, readCloud(las).data);
  EXPECT_NE(facts.las, nullptr);
  EXPECT_TRUE(facts.remarks.empty());
}

TEST_F(ReadSystems, TheSettingsCountAndAreTold)
{
  const auto las = folder.write("a.las", lasOfZone33(wktRecord(utm_33_wkt)).text());
  CloudFacts facts;
  EXPECT_EQ(readCloud(las, &facts, systemsOf("EPSG:25832", "")).data, readCloud(las).data);
  EXPECT_EQ(facts.coordinate_system.definition, "EPSG:25832");
  EXPECT_THAT(facts.remarks, testing::ElementsAre("its coordinate system is 'ETRS89 / UTM zone 33N': it is read as "
                                                  "'ETRS89 / UTM zone 32N (EPSG:25832)', as was given"));
  EXPECT_EQ(openCloud(las, 1 << 20, systemsOf("EPSG:25832", ""))->facts().remarks, facts.remarks);
  EXPECT_EQ(readCloud(las, &facts, systemsOf(no_system, "EPSG:25832")).data, readCloud(las).data);
  EXPECT_EQ(facts.coordinate_system.name, "") << "it is of none";
  EXPECT_TRUE(facts.remarks.empty());
}

TEST_F(ReadSystems, E57IsInMetres)
{
  E57Sample sample;
  E57SampleScan scan;
  scan.values = {E57SampleValue::doubles("cartesianX", {500000}), E57SampleValue::doubles("cartesianY", {5400000}),
                 E57SampleValue::doubles("cartesianZ", {7})};
  sample.scans = {scan};
  const auto with = [&](const std::string& metadata) {
    sample.more_xml = "<coordinateMetadata type=\"String\"><![CDATA[" + metadata + "]]></coordinateMetadata>";
    return folder.write("a.e57", sample.text());
  };
  CloudFacts facts;
  EXPECT_GT(viewOf(readCloud(with(utm_33_wkt), &facts, systemsOf("", "EPSG:25832"))).point(0)[0], 940000);
  EXPECT_EQ(facts.unit, LengthUnit::m);
  EXPECT_THAT(refusal(with(""), systemsOf("", "EPSG:25832")), HasSubstr("a.e57: names no coordinate system"));
  EXPECT_THAT(refusal(with("PROJCS[\"a hall\"]"), systemsOf("", "EPSG:25832")),
              HasSubstr("a.e57: has the coordinate system 'a hall', which PROJ does not know"));
  EXPECT_THAT(refusal(with(utm_33_wkt), systemsOf("EPSG:2229", "EPSG:25832")),
              HasSubstr("a.e57: has lengths in m, which is not the unit of 'NAD83 / California zone 5 (ftUS)"));
}

TEST_F(ReadSystems, WhatHasNoneIsRefused)
{
  const auto file = folder.write("a.xyz", "500000 5400000 7\n");
  EXPECT_THAT(refusal(file, systemsOf("", "EPSG:25832")),
              HasSubstr("a.xyz: names no coordinate system, and is wanted in EPSG:25832: name its system, too"));
  EXPECT_THAT(refusal(file, systemsOf("EPSG:25833", "EPSG:99999")),
              HasSubstr("'EPSG:99999' is no coordinate system that PROJ knows"));
  EXPECT_THAT(refusal(file, systemsOf("EPSG:99999", "")), HasSubstr("'EPSG:99999' is no coordinate system"));
  ReadSettings both = systemsOf("EPSG:25833", "EPSG:25832");
  both.unit = LengthUnit::mm;
  EXPECT_THAT(refusal(file, both), HasSubstr("is wanted in the coordinate system EPSG:25832 and in units, too"));
  const auto far = folder.write("far.xyz", "500000 5400000 7\n1e12 1e12 7\n");
  EXPECT_THAT([&] { readCloud(far, nullptr, systemsOf("EPSG:25833", "EPSG:25832")); },
              testing::ThrowsMessage<files::FileError>(HasSubstr("far.xyz: has record 1 at (1e+12, 1e+12, 7)")));
}

/// GeoTIFF's keys with a projected system, and of heights.
std::string keysOf(const std::vector<std::pair<int, int>>& codes)
{
  std::string bytes(8, '\0');
  put(bytes, 0, std::uint16_t{1});
  put(bytes, 6, static_cast<std::uint16_t>(codes.size()));
  for (const auto& [key, code] : codes)
    for (const int number : {key, 0, 1, code}) put(bytes, bytes.size(), static_cast<std::uint16_t>(number));
  return LasSample::record("LASF_Projection", 34735, bytes);
}

TEST(LasDefinition, IsOfTheRecordThatCounts)
{
  const auto of = [](const std::string& record) {
    return systemOf(LasReader(std::make_unique<HeldBytes>(lasOfZone33(record).text())).lasHeader()).definition;
  };
  EXPECT_EQ(of(wktRecord(std::string(utm_33_wkt) + '\0')), utm_33_wkt);
  EXPECT_EQ(of(keysOf({{3072, 25833}})), "EPSG:25833");
  EXPECT_EQ(of(keysOf({{2048, 4258}})), "EPSG:4258");
  EXPECT_EQ(of(keysOf({{3072, 25833}, {4096, 7837}})), "EPSG:25833+7837");
  EXPECT_EQ(of(keysOf({{3072, 26915}, {4096, 5103}, {4099, 9001}})), "EPSG:26915+5703") << "the datum's code";
  EXPECT_EQ(of(keysOf({{3072, 26915}, {4096, 5104}})), "EPSG:26915+5736");
  EXPECT_EQ(of(keysOf({{3072, 26915}, {4096, 5103}, {4099, 9003}})), "EPSG:26915") << "heights in feet";
  EXPECT_EQ(of(keysOf({{3072, 32767}})), "") << "a system of the user's own";
  EXPECT_EQ(of(LasSample::record("somebody", 1, "else")), "");
}

} // namespace
} // namespace pcl_bsh::io
