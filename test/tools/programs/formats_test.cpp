// SPDX-License-Identifier: BSD-3-Clause
// Every program takes every format, wherever it takes a cloud.
#include "program_run.h"
#include "support/e57_sample.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <gmock/gmock.h>

#include <sstream>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

class EveryFormat : public testing::Test {
protected:
  /// Thirty corners of ten triangles, near the origin, once in each format: a mesh where it has faces.
  EveryFormat()
  {
    pcl::PointCloud<pcl::PointXYZ> corners;
    std::ostringstream off, obj, stl, faces;
    off << "OFF\n30 10 0\n";
    stl << "solid c\n";
    for (int i = 0; i < 30; ++i) {
      corners.emplace_back(0.1f * static_cast<float>(i * 7 % 10), 0.1f * static_cast<float>(i * 3 % 10),
                           0.03f * static_cast<float>(i + 1));
      const pcl::PointXYZ& p = corners.back();
      std::ostringstream place;
      place << p.x << ' ' << p.y << ' ' << p.z << '\n';
      off << place.str();
      obj << "v " << place.str();
      if (i % 3 == 0) stl << "facet normal 0 0 1\nouter loop\n";
      stl << "vertex " << place.str();
      if (i % 3 == 2) {
        stl << "endloop\nendfacet\n";
        faces << "3 " << i - 2 << ' ' << i - 1 << ' ' << i << '\n';
        obj << "f " << i - 1 << ' ' << i << ' ' << i + 1 << '\n';
      }
    }
    folder.write("c.off", off.str() + faces.str());
    folder.write("c.obj", obj.str());
    folder.write("c.stl", stl.str() + "endsolid c\n");
    pcl::PCLPointCloud2 cloud;
    pcl::toPCLPointCloud2(corners, cloud);
    io::writeMesh(folder / "mesh.ply", cloud, io::readMesh(folder / "c.off").triangles);
    for (const char* name : {"c.pcd", "c.ply", "c.las", "c.pts", "c.ptx", "c.csv", "c.xyz", "c.asc", "c.txt"})
      io::writeCloud(folder / name, cloud);
    std::vector<std::vector<double>> axes(3);
    for (const pcl::PointXYZ& corner : corners)
      for (std::size_t k = 0; k < 3; ++k) axes[k].push_back(corner.data[k]);
    folder.write("c.e57", E57Sample{{E57Sample::points(axes[0], axes[1], axes[2])}}.text());
  }

  /// In the folder of the clouds. @return what it said
  std::string expectDone(const std::string& program, const std::string& arguments) const
  {
    const Outcome done = run(program, arguments, folder.path());
    EXPECT_EQ(done.exit_code, 0) << program << ' ' << arguments << '\n' << done.err;
    return done.out + done.err;
  }

  /// Each format once in the first place and once in the second.
  template <typename Use>
  static void forEachPair(const Use& use)
  {
    for (std::size_t i = 0; i < names.size(); ++i) use(names[i], names[(i + 1) % names.size()]);
  }

  static const std::vector<std::string> names;
  io::TemporaryFolder folder;
};

const std::vector<std::string> EveryFormat::names = {"c.pcd", "c.ply", "mesh.ply", "c.las", "c.e57", "c.pts", "c.ptx",
                                                     "c.csv", "c.xyz", "c.asc",    "c.txt", "c.off", "c.obj", "c.stl"};

TEST_F(EveryFormat, IsTakenByCollide)
{
  forEachPair([&](const std::string& input, const std::string& obstacle) {
    EXPECT_THAT(expectDone("pcl_bsh_collide", input + " " + obstacle + " out.ply --clearance 0.05"),
                HasSubstr(" collide"));
  });
}

TEST_F(EveryFormat, IsTakenByAccuracy)
{
  forEachPair([&](const std::string& a, const std::string& b) {
    expectDone("pcl_bsh_accuracy", a + " " + b + " --clearance 0.05 --repeat 1 --out study");
  });
}

/// Each program that reads a cloud refuses a transform that scales, unless that is allowed.
TEST_F(EveryFormat, ATransformThatScalesIsRefusedUnlessAllowed)
{
  const std::string axes = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  folder.write("s.ptx", "1\n2\n" + axes + "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n1 0 0 0.2\n0 1 0 0.2\n");
  folder.write("m.ptx", "1\n1\n" + axes + "1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n1 0 0 0.2\n");
  expectDone("pcl_bsh_site", "make c.pcd --out site");
  const std::pair<const char*, const char*> commands[] = {
      {"pcl_bsh_collide", "s.ptx c.pcd out.pcd --clearance 0.05"},
      {"pcl_bsh_collide", "c.pcd s.ptx out.pcd --clearance 0.05"},
      {"pcl_bsh_accuracy", "c.pcd s.ptx --clearance 0.05 --repeat 1 --out study"},
      {"pcl_bsh_certify", "s.ptx --sample 1 --fit box"},
      {"pcl_bsh_view", "s.ptx --size 160x120 --screenshot out.png"},
      {"pcl_bsh_site", "make c.pcd s.ptx --out scaled"},
      {"pcl_bsh_site", "collide site s.ptx --clearance 0.05 --report report.json"}};
  for (const auto& [program, arguments] : commands) {
    if (!std::filesystem::exists(std::string(PCL_BSH_PROGRAM_DIR "/") + program)) continue;
    const Outcome refused = run(program, arguments, folder.path());
    EXPECT_EQ(refused.exit_code, 1) << program << ' ' << arguments << '\n' << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("s.ptx: scan 0 has a transform that scales by 2: give --allow-scale"));
    expectDone(program, std::string(arguments) + " --allow-scale");
    std::string mirrored = std::string(arguments) + " --allow-scale";
    mirrored.replace(mirrored.find("s.ptx"), 1, "m");
    EXPECT_THAT(run(program, mirrored, folder.path()).err,
                HasSubstr("m.ptx: scan 0 has a transform that mirrors: export it again"))
        << program << ' ' << mirrored;
  }
}

TEST_F(EveryFormat, IsTakenByCertify)
{
  if (!std::filesystem::exists(PCL_BSH_PROGRAM_DIR "/pcl_bsh_certify")) GTEST_SKIP() << "built without CGAL";
  for (const std::string& name : names) expectDone("pcl_bsh_certify", name + " --sample 1 --fit box");
}

TEST_F(EveryFormat, IsTakenByView)
{
  if (!std::filesystem::exists(PCL_BSH_PROGRAM_DIR "/pcl_bsh_view")) GTEST_SKIP() << "built without VTK";
  forEachPair([&](const std::string& input, const std::string& obstacle) {
    expectDone("pcl_bsh_view", input + " " + obstacle + " --model " + obstacle +
                                   " --clearance 0.05 --size 160x120 --screenshot out.png");
  });
}

TEST_F(EveryFormat, IsTakenBySite)
{
  std::string all;
  for (const std::string& name : names) all += " " + name;
  expectDone("pcl_bsh_site", "make" + all + " --vertices-only --out site");
  EXPECT_THAT(expectDone("pcl_bsh_site", "validate site"), HasSubstr(std::to_string(30 * names.size())));
  for (const std::string& name : names)
    expectDone("pcl_bsh_site", "collide site " + name + " --clearance 0.05 --report report.json");
}

TEST_F(EveryFormat, IsTakenByScene)
{
  std::string clouds, objects;
  for (const std::string& name : names) {
    const std::string between = clouds.empty() ? "" : ", ";
    clouds += between + "\"" + name + "\": \"" + name + '"';
    objects += between + R"({"name": ")" + name + R"(", "cloud": ")" + name + "\"}";
  }
  folder.write("scene.json", "{\"clouds\": {" + clouds + "}, \"objects\": [" + objects +
                                 R"(], "clearance": 0.05, "tolerance": 0.01, "steps": 1, "dt": 0.1,
                                 "effects": {"any": true}})");
  EXPECT_THAT(expectDone("pcl_bsh_scene", "scene.json"), HasSubstr(std::to_string(names.size()) + " objects"));
}

/// Written, too, where the format can be.
TEST_F(EveryFormat, IsTakenByPipeline)
{
  const auto output = [](const std::string& input) {
    return "out_" + input +
           (input.ends_with(".off") || input.ends_with(".stl") || input.ends_with(".e57") ? ".pcd" : "");
  };
  const auto writer = [](const std::string& file) {
    const std::string extension = file.substr(file.rfind('.') + 1);
    const bool columns = extension == "csv" || extension == "xyz" || extension == "asc" || extension == "txt";
    return "{\"type\": \"writers." + (columns ? "text" : extension) + "\", \"filename\": \"" + file + "\"}";
  };
  std::string stages;
  forEachPair([&](const std::string& input, const std::string& obstacle) {
    stages += (stages.empty() ? "\"" : ",\n\"") + input +
              R"(", {"type": "filters.bsh_flag", "clearance": 0.05, "obstacle": ")" + obstacle + "\"}, " +
              writer(output(input));
  });
  folder.write("pipeline.json", "[" + stages + "]");
  expectDone("pcl_bsh_pipeline", "pipeline.json");
  for (const std::string& name : names) EXPECT_EQ(io::readCloud(folder / output(name)).width, 30u) << name;
}

} // namespace
} // namespace pcl_bsh
