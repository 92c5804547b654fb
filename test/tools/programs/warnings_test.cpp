// SPDX-License-Identifier: BSD-3-Clause
// Every program gives the warnings of one.
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <gmock/gmock.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A question, asked of each program in its own way.
struct Asked {
  std::string input, obstacle;
  std::string clearance;
  std::string pose = "0,0,0,0,0,0";
};

class Warnings : public testing::Test {
protected:
  Warnings()
  {
    writeFloor("floor.pcd", 0);
    writeFloor("utm.pcd", 500000);
    folder.write("none.xyz", "nan 0 0\nnan nan 0\n");
  }

  /// 20 x 20 points, one apart; at 500 km float32 counts in steps of 1/32.
  void writeFloor(const std::string& name, float x)
  {
    pcl::PointCloud<pcl::PointXYZ> floor;
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j) floor.emplace_back(x + static_cast<float>(i), static_cast<float>(j), 0.0f);
    pcl::PCLPointCloud2 cloud;
    pcl::toPCLPointCloud2(floor, cloud);
    io::writeCloud(folder / name, cloud);
  }

  std::string done(const std::string& program, const std::string& arguments) const
  {
    const Outcome outcome = run(program, arguments, folder.path());
    EXPECT_EQ(outcome.exit_code, 0) << program << ' ' << arguments << '\n' << outcome.err;
    return outcome.err;
  }

  std::string siteOf(const std::string& cloud) const
  {
    const std::string site = "site_of_" + cloud;
    if (!std::filesystem::exists(folder / site)) done("pcl_bsh_site", "make " + cloud + " --out " + site);
    return site;
  }

  std::string scene(const Asked& asked) const
  {
    folder.write("scene.json", R"({"clouds": {"a": ")" + asked.input + R"(", "b": ")" + asked.obstacle +
                                   R"("}, "objects": [{"name": "a", "cloud": "a", "fixed": true}, {"name": "b", "cloud":
                                   "b", "pose": [)" +
                                   asked.pose + R"(]}], "clearance": )" + asked.clearance +
                                   R"(, "tolerance": 0.1, "steps": 1, "dt": 0.1, "effects": {"any": true}})");
    return done("pcl_bsh_scene", "scene.json");
  }

  std::string pipeline(const Asked& asked) const
  {
    folder.write("pipeline.json", "[\"" + asked.input + R"(", {"type": "filters.bsh_flag", "clearance": )" +
                                      asked.clearance + R"(, "obstacle": ")" + asked.obstacle + R"(", "pose": [)" +
                                      asked.pose + R"(]}, "out.pcd"])");
    return done("pcl_bsh_pipeline", "pipeline.json");
  }

  /// The warnings of each program, by its name.
  std::map<std::string, std::string> told(const Asked& asked) const
  {
    const std::string how = " --clearance " + asked.clearance + " --pose " + asked.pose;
    std::map<std::string, std::string> all;
    all["collide"] = done("pcl_bsh_collide", asked.input + ' ' + asked.obstacle + " out.ply" + how);
    all["scene"] = scene(asked);
    all["pipeline"] = pipeline(asked);
    const std::string report = " --report report.json";
    const std::string of_site = "collide " + siteOf(asked.input) + ' ';
    const bool asks_sites = run("pcl_bsh_site", "collide --help").out.find("--clearance") != std::string::npos;
    if (asks_sites) {
      all["site"] = done("pcl_bsh_site", of_site + asked.obstacle + how + report);
      all["two sites"] = done("pcl_bsh_site", of_site + siteOf(asked.obstacle) + how + report);
    }
    if (std::filesystem::exists(PCL_BSH_PROGRAM_DIR "/pcl_bsh_view"))
      all["view"] =
          done("pcl_bsh_view", asked.input + " --model " + asked.obstacle + how + " --size 64x64 --screenshot out.png");
    const bool measurable = asked.obstacle != "none.xyz"; // else it refuses
    if (measurable && std::filesystem::exists(PCL_BSH_PROGRAM_DIR "/pcl_bsh_accuracy"))
      all["accuracy"] = done("pcl_bsh_accuracy", asked.input + ' ' + asked.obstacle + how + " --repeat 1 --out study");
    return all;
  }

  void expectAllTell(const Asked& asked, const std::string& text) const
  {
    for (const auto& [program, err] : told(asked)) EXPECT_THAT(err, HasSubstr(text)) << program;
  }

  io::TemporaryFolder folder;
};

std::size_t countOf(const std::string& text, const std::string& part)
{
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(Warnings, NoneWhereAllIsInOrder)
{
  for (const auto& [program, err] : told({"floor.pcd", "floor.pcd", "2"}))
    EXPECT_THAT(err, Not(HasSubstr("warning"))) << program;
}

TEST_F(Warnings, CoarseCoordinates)
{
  expectAllTell({"utm.pcd", "floor.pcd", "0.25", "500000,0,0,0,0,0"},
                ": its float32 coordinates lie 0.03125 apart, coarse for a clearance of 0.25: ");
}

TEST_F(Warnings, ObstaclesWithoutAPoint)
{
  expectAllTell({"floor.pcd", "none.xyz", "2"}, ": has no finite point: nothing collides with it");
}

TEST_F(Warnings, HolesThatCollisionsHideIn)
{
  expectAllTell({"floor.pcd", "floor.pcd", "1"}, ": surfaces may touch with no two points within the clearance of 1: ");
}

TEST_F(Warnings, FramesThatNeverMeet)
{
  expectAllTell({"floor.pcd", "floor.pcd", "2", "5000000,0,0,0,0,0"},
                ", with all of its motion, are 4.99998e+06 apart");
}

TEST_F(Warnings, AnglesInDegrees)
{
  expectAllTell({"floor.pcd", "floor.pcd", "2", "0,0,0,0,0,90"},
                ": an angle of 90 radians is 14.3239 turns: give radians: 90 degrees are 1.5708");
}

/// A pipeline knows its clouds as the input and the obstacle, a site is another one than the file.
TEST_F(Warnings, OfOneFileTwiceOnce)
{
  for (const auto& [program, err] : told({"utm.pcd", "utm.pcd", "0.25"})) {
    const std::size_t names = program == "pipeline" || program == "site" ? 2 : 1;
    EXPECT_EQ(countOf(err, ": its float32 coordinates"), names) << program;
  }
  folder.write("loose.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n");
  EXPECT_EQ(countOf(done("pcl_bsh_collide", "loose.obj loose.obj out.ply --clearance 0.1"), "belongs to no face"), 1u);
}

} // namespace
} // namespace pcl_bsh
