// SPDX-License-Identifier: BSD-3-Clause
// Files name normals and colours in their own way; between reader and writer they have PCL's names and meaning.
#include "io/clouds/laz_encoder.h"
#include "io/clouds/laz_sample.h"
#include "io/clouds/samples.h"
#include "run_stage.h"
#include "support/e57_sample.h"
#include "support/threads_of.h"

#include <pcl_bsh/base/parallel.h>

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <cmath>
#include <limits>

namespace pcl_bsh::pipeline {
namespace {

using io::contentOf;
using testing::HasSubstr;

/// A quarter turn about z.
constexpr auto turn = R"({"type": "filters.transform", "transform": [0, 0, 0, 0, 0, 1.5707963267948966]})";

class FileFields : public testing::Test {
protected:
  PipelineResult run(const std::string& in, const std::string& stages, const std::string& out) const
  {
    return Pipeline::parse("[\"" + (folder / in).string() + "\", " + stages + ", \"" + (folder / out).string() + "\"]")
        .run();
  }

  io::TemporaryFolder folder;
};

TEST_F(FileFields, NormalsOfFilesAreTurned)
{
  folder.write("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
               "property float nx\nproperty float ny\nproperty float nz\nend_header\n1 0 0 1 0 0\n");
  folder.write("a.txt", "//X Y Z Nx Ny Nz\n1 0 0 1 0 0\n");
  folder.write("a.obj", "vn 1 0 0\nv 1 0 0\n");
  folder.write("a.off", "NOFF 1 0 0\n1 0 0 1 0 0\n");
  for (const std::string in : {"a.ply", "a.txt", "a.obj", "a.off"}) {
    for (const std::string out : {"b.ply", "b.pcd", "b.xyz", "b.obj"}) {
      EXPECT_THAT(run(in, turn, out).warnings, testing::IsEmpty());
      const pcl::PCLPointCloud2 cloud = io::readCloud(folder / out);
      EXPECT_EQ(io::namesOf(cloud), "x y z normal_x normal_y normal_z") << in << ' ' << out;
      EXPECT_NEAR(io::valueOf(cloud, 0, "y"), 1, 1e-7) << in << ' ' << out;
      EXPECT_NEAR(io::valueOf(cloud, 0, "normal_x"), 0, 1e-7) << in << ' ' << out;
      EXPECT_NEAR(io::valueOf(cloud, 0, "normal_y"), 1, 1e-7) << in << ' ' << out;
    }
  }
}

TEST_F(FileFields, ColoursOfFilesAreAveragedAsColours)
{
  folder.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
                        "z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
                        "0 0 0 200 0 10\n0.1 0 0 100 50 20\n");
  folder.write("a.txt", "//X,Y,Z,R,G,B\n0,0,0,200,0,10\n0.1,0,0,100,50,20\n");
  folder.write("a.off", "COFF 2 0 0\n0 0 0 200 0 10\n0.1 0 0 100 50 20\n");
  const std::string grid = R"({"type": "filters.voxel_grid", "leaf_size": 1})";
  for (const std::string in : {"a.ply", "a.txt", "a.off"}) {
    for (const std::string out : {"b.ply", "b.pcd", "b.xyz", "b.obj"}) {
      run(in, grid, out);
      const pcl::PCLPointCloud2 cloud = io::readCloud(folder / out);
      ASSERT_EQ(cloud.width, 1U) << in;
      EXPECT_EQ(io::colourOf(cloud, 0) & 0xffffffU, 0x96190fU) << in << ' ' << out;
    }
  }
}

TEST_F(FileFields, ColoursThatAreNoBytesAreWarnedOf)
{
  folder.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
                        "z\nproperty float red\nproperty float green\nproperty float blue\nend_header\n"
                        "0 0 0 0.5 0 1\n");
  const PipelineResult result = run("a.ply", turn, "b.ply");
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_THAT(result.warnings[0],
              HasSubstr("a.ply: field 'red' and the other two channels of its colour are not of type UINT8"));
  EXPECT_THAT(contentOf(folder / "b.ply"), HasSubstr("property float red\n"));
}

TEST_F(FileFields, TheSensorsPlaceIsKept)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, pcl::PCLPointField::FLOAT32);
  io::allocate(cloud, 1);
  io::writeCloud(folder / "a.ply", cloud, {5400000.123, 0, 0, 1, 0, 0, 0});
  run("a.ply", turn, "b.ply");
  io::CloudFacts facts;
  io::readCloud(folder / "b.ply", &facts);
  const io::Viewpoint& viewpoint = facts.viewpoint;
  EXPECT_NEAR(viewpoint[1], 5400000.123, 1e-8);
  EXPECT_NEAR(viewpoint[3], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(viewpoint[6], std::sqrt(0.5), 1e-15);
}

TEST_F(FileFields, ReportsNameTheCoordinateSystem)
{
  io::LasSample sample(4, 6);
  sample.records = {io::LasSample::record("LASF_Projection", 2112, "PROJCS[\"ETRS89 / UTM 32N\"]")};
  sample.addPoints(30);
  folder.write("a.las", sample.text());
  const std::string obstacle = R"("obstacle": ")" + folder.write("robot.xyz", "0 0 0\n").string() + '"';
  const auto stage = [&](const std::string& type, const std::string& file) {
    return R"({"type": ")" + type + R"(", "filename": ")" + (folder / file).string() + R"(", )" + obstacle;
  };
  run("a.las",
      stage("writers.clashes", "clashes.json") + R"(, "clearance": 1}, )" +
          stage("writers.distances", "distances.json") + "}",
      "b.las");
  for (const char* report : {"clashes.json", "distances.json"})
    EXPECT_EQ(nlohmann::json::parse(contentOf(folder / report))["coordinate_system"], "ETRS89 / UTM 32N") << report;
}

/// An obstacle, or a cloud to merge, is in the coordinate system of the input.
TEST_F(FileFields, CloudsOfDifferentCoordinateSystemsAreRefused)
{
  if (!io::hasProj()) GTEST_SKIP() << "install libproj-dev";
  const auto reader = [&](const std::string& tag, const std::string& more) {
    return R"({"type": "readers.text", "tag": ")" + tag + R"(", "filename": ")" +
           folder.write(tag + ".xyz", "500000 5400000 7\n").string() + '"' + more + "}, ";
  };
  const auto refusal = [&](const std::string& more, const std::string& stage) {
    try {
      Pipeline::parse("[" + reader("a", R"(, "crs": "EPSG:25832")") + reader("b", more) + stage +
                      ", {\"filename\": \"" + (folder / "out.pcd").string() + "\"}]")
          .run();
    }
    catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const char* stage : {R"({"type": "filters.bsh_flag", "inputs": ["a"], "obstacle": "b", "clearance": 1})",
                            R"({"type": "filters.merge", "inputs": ["a", "b"]})"}) {
    EXPECT_THAT(refusal(R"(, "crs": "EPSG:25833")", stage),
                HasSubstr("is in 'ETRS89 / UTM zone 33N (EPSG:25833)', and the input in 'ETRS89 / UTM zone 32N "
                          "(EPSG:25832)': give the readers of both `to_crs`"));
    for (const char* fine : {R"(, "crs": "EPSG:25833", "to_crs": "EPSG:25832")", R"(, "crs": "none")", ""})
      EXPECT_EQ(refusal(fine, stage), "") << stage << fine;
    EXPECT_THAT(refusal(R"(, "crs": "EPSG:99999")", stage), HasSubstr("'EPSG:99999' is no coordinate system"));
  }
}

/// Scale, offset, records and waveforms travel with the points through every kind of stage.
TEST_F(FileFields, HeadersOfLasGoFromReaderToWriter)
{
  io::LasSample sample(4, 9, 2);
  sample.global_encoding = 2;
  sample.records = {io::LasSample::record("LASF_Projection", 2112, "PROJCS[...]"),
                    io::LasSample::record("LASF_Spec", 4, io::LasSample::descriptor(3, "width"))};
  sample.extended = {io::LasSample::extendedRecord("LASF_Spec", 65535, "waves")};
  sample.addPoints(30);
  folder.write("a.las", sample.text());
  folder.write("robot.xyz", "0 0 0\n");
  const auto bare = [&](const std::string& stages) {
    EXPECT_THAT(run("a.las", stages, "b.las").warnings, testing::IsEmpty());
    return contentOf(folder / "b.las");
  };
  const std::string all = R"({"type": "filters.pass_through", "filter_field_name": "intensity", "negative": true,
                              "filter_limits": [70000, 80000]})";
  EXPECT_TRUE(bare(all) == sample.text());

  const std::string robot = "\"obstacle\": \"" + (folder / "robot.xyz").string() + "\", \"clearance\": 1";
  const std::string flagged = bare("{\"type\": \"filters.bsh_flag\", " + robot + "}");
  EXPECT_NE(flagged.find("PROJCS"), std::string::npos);
  EXPECT_NE(flagged.find("1 collides"), std::string::npos);
  EXPECT_TRUE(flagged.ends_with("waves"));
  EXPECT_TRUE(bare("{\"type\": \"filters.bsh_collision\", " + robot + "}") == sample.text());

  for (const std::string stage : {R"({"type": "filters.voxel_grid", "leaf_size": 1e6})",
                                  R"({"type": "filters.transform", "transform": [0, 0, 0.001, 0, 0, 0]})"}) {
    const std::string file = bare(stage);
    EXPECT_EQ(io::get<double>(file, 131), sample.scale[0]) << stage;
    EXPECT_NE(file.find("PROJCS"), std::string::npos) << stage;
    EXPECT_TRUE(file.ends_with("waves")) << stage;
  }
}

/// Also where there are fewer stages than threads.
TEST_F(FileFields, LazIsReadOnTheThreadsOfThePipeline)
{
  static const io::TemporaryFolder own;
  io::LasSample sample(4, 6);
  io::addScan(sample, 1000);
  const auto file = own.write("a.laz", io::laz_test::compressed(sample.text()));
  const auto run_on = [&](unsigned threads) {
    Pipeline pipeline = Pipeline::parse("[\"" + file.string() + "\"]");
    pipeline.setNumberOfThreads(threads);
    pipeline.run();
  };
  expectOtherThreads(false, [&] { run_on(1); });
  if (threadCount(2) == 2) expectOtherThreads(true, [&] { run_on(2); });
}

TEST_F(FileFields, LasLeavesOutWhatIsNotFinite)
{
  folder.write("a.xyz", "0 0 0\nnan 0 0\n1 1 1\n");
  const auto warnings = run("a.xyz", R"({"type": "filters.merge"})", "b.las").warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("1 is left out"));
  EXPECT_EQ(io::readCloud(folder / "b.las").width, 2U);
}

/// And says which points and fields; what is no field but padding is not missed.
TEST_F(FileFields, FormatsWithoutAPlaceForEverythingLeaveItOut)
{
  const auto cloud = std::make_shared<StageCloud>();
  for (const char* axis : {"x", "y", "z", "intensity"}) io::addField(cloud->cloud, axis, pcl::PCLPointField::FLOAT32);
  io::addField(cloud->cloud, "_", pcl::PCLPointField::UINT8, 4);
  io::addField(cloud->cloud, "label", pcl::PCLPointField::UINT16);
  io::addField(cloud->cloud, "scan", pcl::PCLPointField::UINT32);
  io::allocate(cloud->cloud, 4);
  const float place = 1.0F;
  for (std::size_t i = 0; i < 4; ++i)
    std::memcpy(&cloud->cloud.data[i * cloud->cloud.point_step], &place, sizeof place);
  const auto warningsOf = [&](const std::string& extension) {
    const std::string file = (folder / ("b" + extension)).string();
    PipelineResult result = runStage(cloud, "{\"filename\": \"" + file + "\"}");
    for (std::string& warning : result.warnings) warning.erase(0, warning.find(": ") + 2);
    return result.warnings;
  };
  using testing::ElementsAre;
  const std::string lost = " has no place for the fields", end = ": they are left out";
  EXPECT_THAT(warningsOf(".pts"), ElementsAre("a .pts" + lost + " label scan" + end));
  EXPECT_EQ(io::namesOf(io::readCloud(folder / "b.pts")), "x y z intensity");
  EXPECT_THAT(warningsOf(".ptx"), ElementsAre("a .ptx" + lost + " label" + end));
  EXPECT_THAT(warningsOf(".obj"), ElementsAre("an .obj" + lost + " intensity label scan" + end));
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (const std::size_t i : {1U, 3U}) {
    std::memcpy(&cloud->cloud.data[i * cloud->cloud.point_step], &none, sizeof none);
    const std::string points = i == 1 ? "1 is left out" : "2 are left out";
    EXPECT_THAT(warningsOf(".pts"), ElementsAre("a .pts" + lost + " label scan" + end,
                                                "a .pts has no place for points that are not finite: " + points));
    EXPECT_THAT(warningsOf(".las"), testing::Contains("a .las has no place for points that are not finite: " + points));
    EXPECT_THAT(warningsOf(".ptx"), testing::SizeIs(1)) << "no return";
  }
}

TEST_F(FileFields, ColumnsOfATextMayBeNamed)
{
  std::string rows;
  for (int i = 1; i < 13; ++i) rows += std::to_string(i) + ",2.5,3.5,4." + std::to_string(i) + "\n";
  const auto text = folder.write("a.csv", rows);
  const auto read = [&](const std::string& columns) {
    return Pipeline::parse("[{\"type\": \"readers.text\", \"filename\": \"" + text.string() + "\", \"columns\": \"" +
                           columns + "\"}]")
        .run();
  };
  const PipelineResult named = read("y,x,_,z");
  const pcl::PCLPointCloud2& cloud = named.clouds.begin()->second->cloud;
  EXPECT_EQ(io::namesOf(cloud), "y x z");
  EXPECT_EQ(io::valueOf(cloud, 1, "z"), 4.2);
  EXPECT_THAT(named.warnings, testing::IsEmpty());
  EXPECT_THAT(read("").warnings, testing::ElementsAre(HasSubstr(text.string() + ": "))) << "what it is taken for";
  EXPECT_THAT(errorOf([&] { read("x,y,z,x"); }), HasSubstr("/0/columns: names two columns x: "));
}

TEST_F(FileFields, AFileOfAnotherFormatIsRefused)
{
  EXPECT_THAT(errorOf([] { Pipeline::parse(R"([{"type": "readers.las", "filename": "a.pcd"}])").validate(); }),
              testing::EndsWith("/0/filename: is \"a.pcd\": give a .las or .laz file, or leave out the type"));
}

TEST_F(FileFields, OneScanOfSeveral)
{
  const std::string head = "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 ";
  folder.write("a.ptx", head + "5 1\n1 2 3 0.5\n" + head + "9 1\n1 2 3 0.5\n");
  const auto read = [&](const std::string& option, const std::string& format = "ptx") {
    Pipeline::parse("[{\"type\": \"readers." + format + "\", \"filename\": \"" + (folder / ("a." + format)).string() +
                    "\"" + option + "}, \"" + (folder / "b.pcd").string() + "\"]")
        .run();
    io::CloudFacts facts;
    const pcl::PCLPointCloud2 cloud = io::readCloud(folder / "b.pcd", &facts);
    const io::Viewpoint& viewpoint = facts.viewpoint;
    return io::namesOf(cloud) + " " + std::to_string(cloud.width) + " " +
           std::to_string(static_cast<int>(viewpoint[2]));
  };
  EXPECT_EQ(read(""), "x y z intensity scan 2 5");
  EXPECT_EQ(read(", \"scan\": 1"), "x y z intensity 1 9");
  EXPECT_THROW(read(", \"scan\": 2"), std::exception);

  E57SampleScan first = E57Sample::points({1}, {2}, {3}), second = E57Sample::points({1, 2}, {3, 4}, {5, 6});
  first.more_xml = E57SampleScan::pose("", "0 0 5");
  second.more_xml = E57SampleScan::pose("", "0 0 9");
  folder.write("a.e57", E57Sample{{first, second}}.text());
  EXPECT_EQ(read("", "e57"), "x y z scan 3 5");
  EXPECT_EQ(read(", \"scan\": 1", "e57"), "x y z 2 9");
  EXPECT_THROW(read(", \"scan\": 2", "e57"), std::exception);
}

/// From an E57 as from a LAS, through a stage that selects points.
TEST_F(FileFields, ListsNameTheCoordinateSystem)
{
  E57Sample sample{{E57Sample::points({1, 2, 3}, {0, 0, 0}, {0, 0, 0})}};
  sample.more_xml = "<coordinateMetadata>PROJCS[&quot;UTM 32N&quot;]</coordinateMetadata>";
  folder.write("a.e57", sample.text());
  folder.write("b.xyz", "x y z\n1 0 0\n");
  const auto path = [&](const char* name) { return '"' + (folder / name).string() + '"'; };
  const std::string asked = ", \"obstacle\": " + path("b.xyz") + ", \"clearance\": 0.5}";
  Pipeline::parse(
      "[" + path("a.e57") +
      R"(, {"type": "filters.crop_box", "min": [0, -1, -1], "max": [2.5, 1, 1]}, {"type": "filters.bsh_flag")" + asked +
      R"(, {"type": "writers.clashes", "filename": )" + path("c.json") + asked + "]")
      .run();
  EXPECT_THAT(contentOf(folder / "c.json"), HasSubstr("\"coordinate_system\": \"UTM 32N\""));
}

TEST_F(FileFields, TransformsOfScansMayScaleWhereThatIsAllowed)
{
  const std::string head = "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", end = "5 6 7 1\n1 2 3 0.5\n";
  const auto read = [&](const std::string& rows, const std::string& option) {
    folder.write("a.ptx", head + rows + end);
    const PipelineResult result = Pipeline::parse("[{\"type\": \"readers.ptx\", \"filename\": \"" +
                                                  (folder / "a.ptx").string() + "\"" + option + "}]")
                                      .run();
    return io::valueOf(result.clouds.begin()->second->cloud, 0, "x");
  };
  const std::string scaled = "1000 0 0 0\n0 1000 0 0\n0 0 1000 0\n", mirror = "-1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  for (const std::string scan : {"", ", \"scan\": 0"}) {
    EXPECT_THAT(
        errorOf([&] { read(scaled, scan); }),
        testing::AllOf(HasSubstr("a.ptx: scan 0 has a transform that scales by 1000"), HasSubstr("allow_scale")));
    EXPECT_EQ(read(scaled, scan + ", \"allow_scale\": true"), 1005);
    EXPECT_THAT(errorOf([&] { read(mirror, scan + ", \"allow_scale\": true"); }), HasSubstr("mirrors"));
  }
}

} // namespace
} // namespace pcl_bsh::pipeline
