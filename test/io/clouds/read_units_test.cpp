// SPDX-License-Identifier: BSD-3-Clause
// Files that are read in another unit than their own.
#include "las_sample.h"
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/las/notes.h>
#include <pcl_bsh/io/clouds/las/reader.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/search/cloud_view.h>

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ReadSettings unitsOf(std::optional<LengthUnit> unit, std::optional<LengthUnit> to_unit,
                     std::vector<std::string> length_fields = {})
{
  ReadSettings settings;
  settings.unit = unit;
  settings.to_unit = to_unit;
  settings.length_fields = std::move(length_fields);
  return settings;
}

const ReadSettings mm_to_m = unitsOf(LengthUnit::mm, LengthUnit::m);

pcl::PCLPointField fieldOf(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  for (const pcl::PCLPointField& field : cloud.fields)
    if (field.name == name) return field;
  ADD_FAILURE() << name;
  return {};
}

constexpr auto cloud_in_mm =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS intensity x y z sigma ring\nSIZE 4 4 4 4 4 1\n"
    "TYPE F F F F F U\nCOUNT 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 1000 2000 3500 1 0 0 0\n"
    "POINTS 2\nDATA ascii\n0.5 1 2500 -16777216 4 7\n0.25 nan 1 2 3 9\n";

TEST(ReadUnits, ScaleEachLengthOnceInDouble)
{
  const TemporaryFolder folder;
  const auto file = folder.write("mm.pcd", cloud_in_mm);
  CloudFacts facts;
  const pcl::PCLPointCloud2 cloud = readCloud(file, &facts, unitsOf(LengthUnit::mm, LengthUnit::m, {"sigma", "none"}));
  for (const char* length : {"x", "y", "z", "sigma"}) EXPECT_EQ(fieldOf(cloud, length).datatype, Field::FLOAT64);
  EXPECT_EQ(fieldOf(cloud, "intensity").datatype, Field::FLOAT32);
  EXPECT_EQ(viewOf(cloud).point(0), (Point3{0.001, 2.5, -16777.216})) << "float32 would round these";
  EXPECT_TRUE(std::isnan(viewOf(cloud).point(1)[0]));
  EXPECT_EQ(valueOf(cloud, 0, "sigma"), 0.004);
  EXPECT_EQ(valueOf(cloud, 1, "intensity"), 0.25f);
  EXPECT_EQ(valueOf(cloud, 1, "ring"), 9);
  EXPECT_THAT(facts.viewpoint, ElementsAre(1.0, 2.0, 3.5, 1, 0, 0, 0));
  EXPECT_EQ(facts.unit, LengthUnit::m);
  EXPECT_EQ(facts.scale(1000), 1.0);
  EXPECT_THAT(facts.remarks, ElementsAre("its lengths are converted from mm to m"));
  const pcl::PCLPointCloud2 header = readCloudHeader(file, unitsOf(LengthUnit::mm, LengthUnit::m, {"sigma"}));
  ASSERT_EQ(header.fields.size(), cloud.fields.size());
  EXPECT_EQ(header.point_step, cloud.point_step);
  for (std::size_t f = 0; f < header.fields.size(); ++f) EXPECT_EQ(header.fields[f].offset, cloud.fields[f].offset);
}

TEST(ReadUnits, MoveNothingUnlessAsked)
{
  const TemporaryFolder folder;
  const auto file = folder.write("mm.pcd", cloud_in_mm);
  const pcl::PCLPointCloud2 plain = readCloud(file);
  CloudFacts facts;
  for (const auto& settings : {unitsOf(LengthUnit::mm, {}), unitsOf(LengthUnit::mm, LengthUnit::mm)}) {
    const pcl::PCLPointCloud2 cloud = readCloud(file, &facts, settings);
    EXPECT_EQ(cloud.data, plain.data);
    EXPECT_EQ(fieldOf(cloud, "x").datatype, Field::FLOAT32);
    EXPECT_EQ(facts.unit, LengthUnit::mm);
    EXPECT_TRUE(facts.remarks.empty());
    EXPECT_TRUE(facts.scale.isOne());
  }
  readCloud(file, &facts);
  EXPECT_FALSE(facts.unit);
  const auto refusal = [&](const ReadSettings& settings) {
    try {
      readCloud(file, nullptr, settings);
    }
    catch (const files::FileError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(
      refusal(unitsOf({}, LengthUnit::m)),
      HasSubstr("mm.pcd: does not say its unit, and is wanted in m: name its unit, too: mm, cm, m, ft or us-ft"));
  EXPECT_THAT(refusal(unitsOf(LengthUnit::m, LengthUnit::mm, {"x"})), "") << "once";
  const auto far = folder.write("far.xyz", "1e308 0 0\n");
  EXPECT_THAT([&] { readCloud(far, nullptr, unitsOf(LengthUnit::m, LengthUnit::mm)); },
              testing::ThrowsMessage<files::FileError>(HasSubstr("has a length that float64 does not hold")));
}

/// All formats give what scaling their coordinates afterwards gives; streams too, batch by batch.
TEST(ReadUnits, AreOfAllFormats)
{
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> files = {
      folder.write("a.xyz", "1 2 3\n4 5 6\n7 8 9\n"), folder.write("a.obj", "v 1 2 3\nv 4 5 7\nv 7 8 9\nf 1 2 3\n"),
      folder.write("a.off", "OFF\n3 1 0\n1 2 3\n4 5 7\n7 8 9\n3 0 1 2\n"),
      folder.write("a.stl",
                   "solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 4 5 7\nvertex 7 8 9\nendloop\n"
                   "endfacet\nendsolid a\n"),
      folder.write("mm.pcd", cloud_in_mm)};
  LasSample sample(4, 6);
  sample.addPoints(7);
  files.push_back(folder.write("a.las", sample.text()));
  writeCloud(folder / "binary.pcd", readCloud(files.back()));
  files.push_back(folder / "binary.pcd");
  writeCloud(folder / "a.ply", readCloud(folder / "mm.pcd"));
  files.push_back(folder / "a.ply");
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename());
    const pcl::PCLPointCloud2 plain = readCloud(file), scaled = readCloud(file, nullptr, mm_to_m);
    ASSERT_EQ(viewOf(scaled).count, viewOf(plain).count);
    for (std::uint32_t i = 0; i < viewOf(plain).count; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double length = viewOf(plain).point(i)[k];
        EXPECT_TRUE(std::isnan(length) || viewOf(scaled).point(i)[k] == length / 1000) << length;
      }
    const auto stream = openCloud(file, std::uint64_t{1} << 30, mm_to_m);
    EXPECT_EQ(stream->facts().unit, LengthUnit::m);
    EXPECT_EQ(stream->header().point_step, scaled.point_step);
    EXPECT_THAT(stream->facts().remarks, testing::Contains("its lengths are converted from mm to m"));
    std::vector<std::uint8_t> records(scaled.data.size());
    std::size_t read = 0;
    while (const std::size_t points = stream->read(records.data() + read * scaled.point_step, 2)) read += points;
    EXPECT_EQ(read, stream->size());
    EXPECT_EQ(records, scaled.data);
    const auto as_it_is = openCloud(file, std::uint64_t{1} << 30, unitsOf(LengthUnit::mm, {}));
    EXPECT_EQ(as_it_is->header().point_step, plain.point_step);
  }
  const Obstacle mesh = readObstacle(folder / "a.stl", {}, mm_to_m);
  ASSERT_TRUE(mesh.isSurface());
  EXPECT_EQ(mesh.view().triangles->triangle(0)[2], (Point3{0.007, 0.008, 0.009}));
}

constexpr auto us_feet =
    "PROJCS[\"NAD83 / California 6, m \\ in (feet)\",GEOGCS[\"NAD83\",UNIT[\"degree\",0.0174532925199433]],"
    "PARAMETER[\"x\",1],UNIT[\"US survey foot\",0.3048006096012192,AUTHORITY[\"EPSG\",\"9003\"]],"
    "AXIS[\"X\",EAST]]";

TEST(ReadUnits, OfWellKnownText)
{
  EXPECT_EQ(unitOfWkt(us_feet), LengthUnit::us_ft);
  EXPECT_EQ(unitOfWkt("PROJCS [ \"a\" , UNIT [ \"metre\" , 1.0 ] ]"), LengthUnit::m);
  EXPECT_EQ(unitOfWkt("COMPD_CS[\"a\",PROJCS[\"a\",UNIT[\"metre\",1]],VERT_CS[\"b\",UNIT[\"metre\",1]]]"),
            LengthUnit::m);
  EXPECT_FALSE(unitOfWkt("COMPD_CS[\"a\",PROJCS[\"a\",UNIT[\"m\",1]],VERT_CS[\"b\",UNIT[\"ft\",0.3048]]]"))
      << "heights have another one";
  EXPECT_EQ(
      unitOfWkt("PROJCRS[\"a\",BASEGEOGCRS[\"b\",DATUM[\"c\",ELLIPSOID[\"d\",6378137,298,LENGTHUNIT[\"metre\",1]]]],"
                "CONVERSION[\"e\",PARAMETER[\"f\",0,LENGTHUNIT[\"metre\",1]]],CS[Cartesian,2],"
                "AXIS[\"(E)\",east,ORDER[1],LENGTHUNIT[\"foot\",0.3048]],"
                "AXIS[\"(N)\",north,ORDER[2],LENGTHUNIT[\"foot\",0.3048]]]"),
      LengthUnit::ft);
  EXPECT_EQ(unitOfWkt("PROJCRS[\"a\",CS[Cartesian,2],AXIS[\"(E)\",east],LENGTHUNIT[\"metre\",1]]"), LengthUnit::m);
  for (const char* none :
       {"", "GEOGCS[\"NAD83\",UNIT[\"degree\",0.01745]]", "PROJCS[\"UNIT[1,1]\"]", "]]]UNIT[\"m\",1]",
        "PROJCS[\"a\",UNIT[\"link\",0.201168]]", "PROJCS[\"a\",UNIT[", "PROJCS[\"a\",UNIT[\"m\",x]]"})
    EXPECT_FALSE(unitOfWkt(none)) << none;
}

/// GeoTIFF's keys: key, place of its value, count, value.
std::string unitKeys(const std::vector<std::array<std::uint16_t, 4>>& entries)
{
  std::string bytes(8, '\0');
  put(bytes, 0, std::uint16_t{1});
  put(bytes, 6, static_cast<std::uint16_t>(entries.size()));
  for (const auto& entry : entries)
    for (const std::uint16_t number : entry) put(bytes, bytes.size(), number);
  return LasSample::record("LASF_Projection", 34735, bytes);
}

TEST(ReadUnits, OfLas)
{
  const TemporaryFolder folder;
  LasSample sample(4, 6);
  sample.addPoints(3);
  const auto unitOfSample = [&] { return unitOf(LasReader(std::make_unique<HeldBytes>(sample.text())).lasHeader()); };
  EXPECT_FALSE(unitOfSample());
  for (const auto& [code, unit] : {std::pair{9001, LengthUnit::m}, {9002, LengthUnit::ft}, {9003, LengthUnit::us_ft}}) {
    const std::array<std::uint16_t, 4> model = {1024, 0, 1, 1}, system = {3072, 0, 1, 2229},
                                       places = {3076, 0, 1, static_cast<std::uint16_t>(code)};
    sample.records = {unitKeys({model, system, places})};
    EXPECT_EQ(unitOfSample(), unit);
    sample.records = {unitKeys({model, system, places, {4099, 0, 1, static_cast<std::uint16_t>(code)}})};
    EXPECT_EQ(unitOfSample(), unit);
    sample.records = {unitKeys({model, system, places, {4099, 0, 1, 9098}})};
    EXPECT_FALSE(unitOfSample());
  }
  sample.records = {LasSample::record("LASF_Projection", 2112, us_feet)};
  EXPECT_EQ(unitOfSample(), LengthUnit::us_ft);
  const auto file = folder.write("feet.las", sample.text());
  CloudFacts facts;
  const pcl::PCLPointCloud2 plain = readCloud(file, &facts);
  EXPECT_EQ(facts.unit, LengthUnit::us_ft);
  EXPECT_NE(facts.las, nullptr);
  const pcl::PCLPointCloud2 scaled = readCloud(file, &facts, unitsOf({}, LengthUnit::m));
  EXPECT_EQ(facts.unit, LengthUnit::m);
  EXPECT_EQ(facts.las, nullptr) << "it is no longer what its header says";
  EXPECT_EQ(facts.coordinate_system.name, "");
  EXPECT_EQ(viewOf(scaled).point(1)[0], viewOf(plain).point(1)[0] * 1200 / 3937);
  readCloud(file, &facts, unitsOf(LengthUnit::ft, LengthUnit::m));
  EXPECT_THAT(facts.remarks, testing::Contains("its coordinate system is in us-ft: it is read as ft, as was given"));
}

} // namespace
} // namespace pcl_bsh::io
