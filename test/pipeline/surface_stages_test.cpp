// SPDX-License-Identifier: BSD-3-Clause
// Meshes in pipelines: their faces go from the reader to the stage that has them as an obstacle, or a warning says so.
#include "run_stage.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <pcl/point_types.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace pcl_bsh::pipeline {
namespace {

using files::TemporaryFolder;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Points = pcl::PointCloud<pcl::PointXYZ>;

constexpr auto crate = "OFF\n8 6 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 2\n2 0 2\n2 2 2\n0 2 2\n"
                       "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

/// In the middle of a face, 5 cm from it, a metre inside, far away.
StageCloudPtr scan()
{
  Points points;
  points.emplace_back(1.f, 1.f, 2.f);
  points.emplace_back(1.f, 1.f, 2.05f);
  points.emplace_back(1.f, 1.f, 1.f);
  points.emplace_back(9.f, 9.f, 9.f);
  return stageCloud(points);
}

class SurfaceStages : public testing::Test {
protected:
  SurfaceStages() { folder_.write("crate.off", crate); }

  /// Runs stages in a document, whose clouds are `scan` and a crate.
  PipelineResult runAll(const std::string& stages) const
  {
    Pipeline pipeline = Pipeline::parse(
        R"({"pipeline": [{"type": "readers.mesh", "tag": "crate", "filename": ")" + (folder_ / "crate.off").string() +
        R"("}, {"type": "readers.pcd", "tag": "scan", "filename": "scan.pcd"}, )" + stages + "]}");
    pipeline.setCloud("scan", scan());
    return pipeline.run();
  }

  static std::vector<int> flagsOf(const PipelineResult& result, const std::string& tag)
  {
    const pcl::PCLPointCloud2& cloud = result.clouds.at(tag)->cloud;
    std::vector<int> flags;
    for (std::size_t i = 0; i < cloud.width; ++i)
      flags.push_back(cloud.data[i * cloud.point_step + cloud.fields.back().offset]);
    return flags;
  }

  TemporaryFolder folder_;
};

/// Lines join the corners, and nothing but these would be compared.
TEST_F(SurfaceStages, CornersAloneAreNoObstacle)
{
  folder_.write("lines.obj", "v 1 1 2\nv 1 1 1\nl 1 2\n");
  const std::string readers =
      R"({"pipeline": [{"type": "readers.pcd", "tag": "scan", "filename": "scan.pcd"},
          {"type": "readers.mesh", "tag": "lines", "filename": ")" +
      (folder_ / "lines.obj").string() + R"("}, )";
  const std::string flag = R"({"type": "filters.bsh_flag", "tag": "f", "clearance": 0.01, "inputs": ["scan"],
      "obstacle": "lines")";
  const auto runThese = [&](const std::string& stages) {
    Pipeline pipeline = Pipeline::parse(readers + stages + "]}");
    pipeline.setCloud("scan", scan());
    return pipeline.run();
  };
  const auto refusal = [&](const std::string& stages) -> std::string {
    try {
      runThese(stages);
    }
    catch (const std::exception& error) {
      return error.what();
    }
    return "ran";
  };
  EXPECT_THAT(refusal(flag + "}"), HasSubstr("lines.obj: holds 1 line (l) and no faces"));
  EXPECT_THAT(refusal(flag + "}"), HasSubstr("`vertices_only`: true"));
  EXPECT_THAT(refusal(R"({"type": "filters.bsh_flag", "clearance": 0.01, "inputs": ["lines"], "obstacle": "scan"})"),
              HasSubstr("and no faces"));
  const PipelineResult corners = runThese(flag + R"(, "vertices_only": true})");
  EXPECT_THAT(flagsOf(corners, "f"), ElementsAre(1, 0, 1, 0));
  EXPECT_THAT(corners.warnings, Contains(HasSubstr("its 1 line (l) is not compared")));
}

TEST_F(SurfaceStages, FlagWhatIsNearTheFaces)
{
  const PipelineResult surface = runAll(R"({"type": "filters.bsh_flag", "tag": "f", "inputs": ["scan"],
      "obstacle": "crate", "clearance": 0.1})");
  EXPECT_THAT(flagsOf(surface, "f"), ElementsAre(1, 1, 0, 0));
  EXPECT_THAT(surface.warnings,
              ElementsAre(HasSubstr("f: the obstacle is a surface of 12 triangles: what it encloses")));
  const PipelineResult corners = runAll(R"({"type": "filters.bsh_flag", "tag": "f", "inputs": ["scan"],
      "obstacle": "crate", "clearance": 0.1, "vertices_only": true})");
  EXPECT_THAT(flagsOf(corners, "f"), ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(corners.warnings, IsEmpty());
  const PipelineResult kept = runAll(R"({"type": "filters.bsh_collision", "tag": "f", "inputs": ["scan"],
      "obstacle": "crate", "clearance": 0.1, "keep": "colliding"})");
  EXPECT_EQ(kept.clouds.at("f")->cloud.width, 2u);
}

TEST_F(SurfaceStages, TellDistancesToTheFaces)
{
  const std::string file = (folder_ / "distances.json").string();
  const PipelineResult result =
      runAll(R"({"type": "writers.distances", "tag": "w", "inputs": ["scan"], "obstacle": "crate",
      "filename": ")" +
             file + R"("}, {"type": "filters.bsh_distance", "tag": "d", "inputs": ["w"],
      "obstacle": "crate", "filter_limits": [null, 1.5]})");
  const pcl::PCLPointCloud2& cloud = result.clouds.at("d")->cloud;
  ASSERT_EQ(cloud.width, 3u);
  const std::vector<float> truth = {0, 2.05f - 2, 1};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    float distance;
    std::memcpy(&distance, &cloud.data[i * cloud.point_step + cloud.fields.back().offset], sizeof distance);
    EXPECT_EQ(distance, truth[i]) << i;
  }
  const auto json = nlohmann::json::parse(files::contentOf(file));
  EXPECT_EQ(json["surface"]["triangles"], 12);
  EXPECT_DOUBLE_EQ(json["input_to_obstacle"]["maximum"], 7 * std::sqrt(3.0));
  EXPECT_LT(json["hausdorff_pair"][1], 12);
}

TEST_F(SurfaceStages, ListClashesByTriangles)
{
  const std::string file = (folder_ / "clashes.json").string();
  runAll(R"({"type": "writers.clashes", "inputs": ["scan"], "obstacle": "crate", "clearance": 0.1, "filename": ")" +
         file + R"("})");
  const auto json = nlohmann::json::parse(files::contentOf(file));
  ASSERT_EQ(json["clashes"].size(), 1u);
  EXPECT_EQ(json["clashes"][0]["points"], 2);
  EXPECT_EQ(json["clashes"][0]["distance"], 0.0);
  EXPECT_LT(json["clashes"][0]["closest_pair"]["obstacle"]["triangle"], 12);
}

TEST_F(SurfaceStages, FacesGoOnWherePointsStay)
{
  const std::string flag = R"({"type": "filters.bsh_flag", "tag": "f", "inputs": ["scan"], "obstacle": "moved",
      "clearance": 0.1})";
  const PipelineResult moved = runAll(R"({"type": "filters.transform", "tag": "moved", "inputs": ["crate"],
      "transform": [8, 8, 7, 0, 0, 0]}, )" +
                                      flag);
  EXPECT_THAT(flagsOf(moved, "f"), ElementsAre(0, 0, 0, 1)) << "9 9 9 is in the middle of its top";
  const PipelineResult cropped = runAll(R"({"type": "filters.crop_box", "tag": "moved", "inputs": ["crate"],
      "min": [0, 0, 0], "max": [2, 2, 1]}, )" +
                                        flag);
  EXPECT_THAT(flagsOf(cropped, "f"), Each(0));
  EXPECT_THAT(cropped.warnings, Contains(HasSubstr("moved: does not keep the faces of its input")));
  const PipelineResult organized = runAll(R"({"type": "filters.crop_box", "tag": "moved", "inputs": ["crate"],
      "min": [0, 0, 0], "max": [2, 2, 1], "keep_organized": true}, )" +
                                          flag);
  EXPECT_THAT(organized.warnings, Contains(HasSubstr("moved: does not keep the faces of its input")));
}

TEST_F(SurfaceStages, SayWhereFacesEnd)
{
  const PipelineResult written =
      Pipeline::parse("[\"" + (folder_ / "crate.off").string() + "\", {\"type\": \"writers.ply\", \"tag\": \"w\", " +
                      "\"filename\": \"" + (folder_ / "out.ply").string() + "\"}]")
          .run();
  EXPECT_THAT(written.warnings, IsEmpty());
  const io::Mesh mesh = io::readMesh(folder_ / "out.ply");
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.vertices.width, 8u);
  const PipelineResult lost =
      Pipeline::parse("[\"" + (folder_ / "crate.off").string() + "\", {\"type\": \"writers.pcd\", \"tag\": \"w\", " +
                      "\"filename\": \"" + (folder_ / "out.pcd").string() + "\"}]")
          .run();
  EXPECT_THAT(lost.warnings, ElementsAre(HasSubstr("w: faces are not written")));
}

/// Four triangles in a row, the first of which is near the scan's only point; two vertices have no face.
class SurfaceInput : public SurfaceStages {
protected:
  SurfaceInput()
  {
    folder_.write("strip.off", "OFF\n9 4 0\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n0 1 0\n1 1 0\n2 1 0\n3 1 0\n7 7 7\n"
                               "3 0 1 4\n3 1 5 4\n3 1 2 5\n3 2 3 6\n");
    Points points;
    points.emplace_back(0.2f, 0.2f, 0.05f);
    point_ = stageCloud(points);
  }

  PipelineResult runStrip(const std::string& stages) const
  {
    Pipeline pipeline = Pipeline::parse(
        R"({"pipeline": [{"type": "readers.pcd", "tag": "scan", "filename": "scan.pcd"},
           {"type": "readers.mesh", "tag": "strip", "filename": ")" +
        (folder_ / "strip.off").string() + R"("}, )" + stages + "]}");
    pipeline.setCloud("scan", point_);
    return pipeline.run();
  }

  static std::vector<int> faceFlags(const StageCloud& mesh)
  {
    const auto& flags = std::get<std::vector<std::uint8_t>>(mesh.face_properties.at(0).values);
    return {flags.begin(), flags.end()};
  }

  StageCloudPtr point_;
};

TEST_F(SurfaceInput, FlagsTriangles)
{
  const std::string flag = R"({"type": "filters.bsh_flag", "tag": "f", "obstacle": "scan", "clearance": 0.1})";
  const std::string file = (folder_ / "flagged.ply").string();
  const PipelineResult result = runStrip(flag);
  runStrip(flag + R"(, {"type": "writers.ply", "filename": ")" + file + R"("})");
  const StageCloud& mesh = *result.clouds.at("f");
  EXPECT_EQ(mesh.face_properties.at(0).name, "collision");
  EXPECT_THAT(faceFlags(mesh), ElementsAre(1, 0, 0, 0));
  EXPECT_THAT(flagsOf(result, "f"), ElementsAre(1, 1, 0, 0, 1, 0, 0, 0, 0)) << "a vertex is what its triangles are";
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("the input: 2 of its vertices belong to no face")));
  EXPECT_THAT(files::contentOf(file), HasSubstr("property list uchar int vertex_indices\nproperty uchar collision\n"));
  EXPECT_EQ(io::readMesh(file).triangles.size(), 4u);
  const PipelineResult corners = runStrip(R"({"type": "filters.bsh_flag", "tag": "f", "obstacle": "scan",
      "clearance": 0.1, "vertices_only": true})");
  EXPECT_THAT(flagsOf(corners, "f"), Each(0));
  EXPECT_TRUE(corners.clouds.at("f")->triangles) << "they go on";
}

TEST_F(SurfaceInput, FlagsTrianglesAlongAPath)
{
  folder_.write("path.txt", "1 0 0 1.72  0 1 0 0  0 0 1 0\n1 0 0 0  0 1 0 0  0 0 1 -0.05\n");
  const PipelineResult result = runStrip(R"({"type": "filters.bsh_flag", "tag": "f", "obstacle": "scan",
      "clearance": 0.1, "trajectory": ")" +
                                         (folder_ / "path.txt").string() + R"("})");
  const StageCloud& mesh = *result.clouds.at("f");
  EXPECT_THAT(faceFlags(mesh), ElementsAre(1, 0, 1, 1)) << "1.92 0.2 is within 10 cm of both";
  ASSERT_EQ(mesh.face_properties.size(), 4u);
  EXPECT_THAT(std::get<std::vector<std::int32_t>>(mesh.face_properties[2].values), ElementsAre(1, -1, 0, 0));
  EXPECT_FLOAT_EQ(std::get<std::vector<float>>(mesh.face_properties[1].values)[0],
                  static_cast<float>(double{0.05f} - 0.05));
  EXPECT_TRUE(std::isnan(std::get<std::vector<float>>(mesh.face_properties[1].values)[1]));
  EXPECT_EQ(mesh.cloud.fields.back().name, "closest_pose");
}

TEST_F(SurfaceInput, KeepsTrianglesAndTheirVertices)
{
  const auto kept = [&](const std::string& options) {
    const PipelineResult result = runStrip(
        R"({"type": "filters.bsh_collision", "tag": "k", "obstacle": "scan", "clearance": 0.1)" + options + "}");
    const StageCloud& mesh = *result.clouds.at("k");
    for (const Triangle& triangle : *mesh.triangles)
      for (const std::uint32_t corner : triangle) EXPECT_LT(corner, mesh.cloud.width);
    return std::pair(mesh.triangles->size(), mesh.cloud.width);
  };
  EXPECT_EQ(kept(""), std::pair(std::size_t{3}, 6u));
  EXPECT_EQ(kept(R"(, "keep": "colliding")"), std::pair(std::size_t{1}, 3u));
  EXPECT_EQ(kept(R"(, "negative": true)"), std::pair(std::size_t{1}, 3u));
  // Results of triangles go with them, and they are asked again.
  const PipelineResult twice = runStrip(R"({"type": "filters.bsh_flag", "obstacle": "scan", "clearance": 0.1},
      {"type": "filters.bsh_collision", "obstacle": "scan", "clearance": 0.01},
      {"type": "filters.bsh_collision", "tag": "k", "keep": "colliding", "obstacle": "scan", "clearance": 0.1})");
  EXPECT_THAT(faceFlags(*twice.clouds.at("k")), ElementsAre(1));
}

TEST_F(SurfaceInput, TellsDistancesOfTriangles)
{
  const std::string file = (folder_ / "distances.json").string();
  const PipelineResult result = runStrip(R"({"type": "writers.distances", "obstacle": "scan",
      "places_beyond": 0.5, "filename": ")" +
                                         file +
                                         R"("}, {"type": "filters.bsh_distance", "tag": "d", "obstacle": "scan",
      "filter_limits": [null, 1]})");
  const StageCloud& mesh = *result.clouds.at("d");
  EXPECT_EQ(mesh.face_properties.at(0).name, "distance");
  const auto& distances = std::get<std::vector<float>>(mesh.face_properties[0].values);
  ASSERT_EQ(distances.size(), 3u) << "the last is farther";
  EXPECT_EQ(distances[0], 0.05f);
  EXPECT_NEAR(distances[1], std::hypot(0.6 / std::sqrt(2.0), 0.05), 1e-6) << "from the diagonal x + y = 1";
  EXPECT_EQ(mesh.triangles->size(), 3u);
  const auto json = nlohmann::json::parse(files::contentOf(file));
  EXPECT_EQ(json["input_to_obstacle"]["count"], 4);
  ASSERT_FALSE(json["input_to_obstacle"]["places"].empty());
  EXPECT_EQ(json["input_to_obstacle"]["places"][0]["triangle"], 3);
  EXPECT_TRUE(json["obstacle_to_input"]["places"].empty() || json["obstacle_to_input"]["places"][0].contains("point"));
}

TEST_F(SurfaceInput, IsRefusedWherePointsAreAsked)
{
  const auto refusal = [&](const std::string& stage) {
    return errorOf([&] { runStrip(R"({"tag": "s", "obstacle": "scan", )" + stage + "}"); });
  };
  const std::string file = (folder_ / "list.json").string();
  const std::string list = R"("type": "writers.clashes", "clearance": 0.1, "filename": ")" + file + '"';
  EXPECT_THAT(refusal(list), HasSubstr("the input has faces: the stage knows points alone"));
  EXPECT_NO_THROW(runStrip(R"({"tag": "s", "obstacle": "scan", "vertices_only": true, )" + list + "}"));
  const std::string collide = R"("type": "filters.bsh_collision", "clearance": 0.1, )";
  EXPECT_THAT(refusal(collide + R"("keep_organized": true)"), HasSubstr("keep_organized"));
  EXPECT_THAT(refusal(collide + R"("density": true)"), HasSubstr("density"));
  EXPECT_THAT(refusal(collide + R"("uncertainty": "x")"), HasSubstr("the input: is a surface, which has no field 'x'"));
}

/// As an application may give it.
TEST_F(SurfaceStages, RefuseTrianglesOfNoPoints)
{
  const auto mesh = std::make_shared<StageCloud>(*scan());
  mesh->triangles = std::make_shared<const std::vector<Triangle>>(std::vector<Triangle>{{0, 1, 2}, {0, 1, 4}});
  const std::string flag = R"({"type": "filters.bsh_flag", "obstacle": "other", "clearance": 0.1})";
  EXPECT_THAT(errorOf([&] { runStage(scan(), flag, mesh); }), HasSubstr("/obstacle: "));
  EXPECT_THAT(errorOf([&] { runStage(mesh, flag, scan()); }), HasSubstr("/input: "));
}

TEST_F(SurfaceStages, RefuseWhatCannotBe)
{
  const auto refusal = [&](const std::string& options) {
    return errorOf([&] {
      runAll(R"({"type": "filters.bsh_flag", "inputs": ["scan"], "obstacle": "crate", "clearance": 0.1, )" + options +
             "}");
    });
  };
  EXPECT_THAT(refusal(R"("surface_tolerance": 0.1)"), HasSubstr("surface_tolerance"));
  EXPECT_THAT(refusal(R"("obstacle_uncertainty": "x")"),
              HasSubstr("the obstacle: is a surface, which has no field 'x'"));
}

} // namespace
} // namespace pcl_bsh::pipeline
