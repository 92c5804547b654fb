// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/program_run.h"
#include <examples/robot/made_robot.h>

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;

/// A robot that is one ball of radius 1, on a slide along x; four points, of which one is in it, and one is no return.
class SelfFilterProgram : public testing::Test {
protected:
  SelfFilterProgram()
  {
    std::ofstream(folder / "ball.urdf")
        << R"(<robot name="ball"><link name="rail"/><link name="ball"><collision><geometry>
      <sphere radius="1"/></geometry></collision></link><joint name="slide" type="prismatic"><parent link="rail"/>
      <child link="ball"/><limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>)";
    for (const char* name : {"a.csv", "b.csv"})
      std::ofstream(folder / name) << "x,y,z,time\n0,0.1,0,7\n5,0,0,8\nnan,0,0,9\n0,0,0,6\n";
  }

  Outcome filter(const std::string& arguments) const { return run("pcl_bsh_self_filter", arguments, folder.path()); }

  std::string written(const std::string& name) const { return io::contentOf(folder / name); }

  /// One line, the code, and nothing written.
  void expectFailure(const std::string& arguments, int exit_code, const std::string& message) const
  {
    const std::size_t files = folder.files();
    const Outcome failed = filter(arguments);
    EXPECT_EQ(failed.exit_code, exit_code) << arguments;
    EXPECT_THAT(failed.err, StartsWith("pcl_bsh_self_filter: ")) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_EQ(failed.out, "");
    EXPECT_EQ(folder.files(), files) << arguments;
  }

  const io::TemporaryFolder folder;
};

TEST_F(SelfFilterProgram, RemovesTheRobot)
{
  const Outcome done = filter("ball.urdf a.csv --out out");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, StartsWith("a.csv: 1 of 4 points are the robot, 1 is no return, found in "));
  EXPECT_EQ(written("out/a.csv"), "x,y,z,time\n5,0,0,8\n");
}

TEST_F(SelfFilterProgram, FlagsItPerFrameWhereTheJointsPutIt)
{
  std::ofstream(folder / "states.csv") << "slide\n0\n6.01\n";
  const Outcome done = filter("ball.urdf a.csv b.csv --states states.csv --flag --out out --report report.json");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(written("out/a.csv"), "x,y,z,time,collision\n0,0.1,0,7,1\n5,0,0,8,0\nnan,0,0,9,0\n0,0,0,6,1\n");
  EXPECT_EQ(written("out/b.csv"), "x,y,z,time,collision\n0,0.1,0,7,0\n5,0,0,8,1\nnan,0,0,9,0\n0,0,0,6,1\n");
  const Json report = Json::parse(written("report.json"));
  EXPECT_EQ(report["clouds"].size(), 2U);
  EXPECT_EQ(report["clouds"][1]["robot"], 1);
  EXPECT_EQ(report["clouds"][1]["no_returns"], 1);
  EXPECT_EQ(report["padding"], 0.02);
  EXPECT_EQ(report["clouds"][0]["warnings"], Json({"a.csv: 1 of 4 points is not finite: it is left out"}));
  EXPECT_TRUE(report["clouds"][1]["warnings"].empty()) << "each kind once: clouds come in streams";
  EXPECT_EQ(done.err, "pcl_bsh_self_filter: warning: a.csv: 1 of 4 points is not finite: it is left out\n");
  const Outcome piped = filter("ball.urdf a.csv b.csv --states states.csv --out out --report -");
  EXPECT_EQ(Json::parse(piped.out)["clouds"].size(), 2U);
  EXPECT_THAT(piped.err, HasSubstr("b.csv: 1 of "));
}

TEST_F(SelfFilterProgram, SeesFromALink)
{
  EXPECT_EQ(filter("ball.urdf a.csv --joints slide=-5 --frame ball --out out").exit_code, 0);
  EXPECT_EQ(written("out/a.csv"), "x,y,z,time\n5,0,0,8\n"); // the ball is at the origin of its own frame
  EXPECT_EQ(filter("ball.urdf a.csv --joints slide=5.5 --padding 0.6 --out out").exit_code, 0);
  EXPECT_EQ(written("out/a.csv"), "x,y,z,time\n0,0.1,0,7\n");
}

TEST_F(SelfFilterProgram, LinksMayHaveAPaddingOfTheirOwn)
{
  const std::string job = "ball.urdf a.csv --joints slide=6.5 --out out --report report.json --padding ";
  for (const char* padding : {"0.6", "0,ball=0.6", "ball=0.6", "0 --padding ball=0.6", "rail=9,ball=0.6"}) {
    EXPECT_EQ(filter(job + padding).exit_code, 0) << padding;
    EXPECT_EQ(written("out/a.csv"), "x,y,z,time\n0,0.1,0,7\n") << padding;
  }
  EXPECT_EQ(filter(job + "0.6,ball=0.4").exit_code, 0);
  EXPECT_EQ(written("out/a.csv"), "x,y,z,time\n0,0.1,0,7\n5,0,0,8\n");
  const Json report = Json::parse(written("report.json"));
  EXPECT_EQ(report["padding"], 0.6);
  EXPECT_EQ(report["paddings"], Json({{"ball", 0.4}}));
  for (const char* wrong : {"x", "=1", "ball=", "ball=x", "ball=-1", "1,2", "ball=1,ball=1", "nan", "ball=inf"})
    expectFailure(std::string("ball.urdf a.csv --out none --padding ") + wrong, 2, "--padding: ");
  expectFailure("ball.urdf a.csv --out none --padding nose=1", 1, "--padding: link 'nose': is not one of ball");
}

TEST_F(SelfFilterProgram, FindsPackagesByTheEnvironment)
{
  std::filesystem::create_directories(folder / "src/arm/m");
  std::ofstream(folder / "src/arm/package.xml") << "<package><name>arm_description</name></package>";
  std::ofstream(folder / "src/arm/m/a.off")
      << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  std::ofstream(folder / "arm.urdf") << R"(<robot name="arm"><link name="a"><visual><geometry>
      <mesh filename="package://arm_description/m/a.off"/></geometry></visual></link></robot>)";
  expectFailure("arm.urdf a.csv --out none", 1, "say where that package is: --package arm_description=FOLDER");
  ::setenv("ROS_PACKAGE_PATH", ("/opt/nothing:" + (folder / "src").string()).c_str(), 1);
  const Outcome found = filter("arm.urdf a.csv --out out");
  ::unsetenv("ROS_PACKAGE_PATH");
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, StartsWith("a.csv: 1 of 4 points"));
}

TEST_F(SelfFilterProgram, DropsWhatDidNotReturn)
{
  // The ball is elsewhere: what stands at the sensor's own origin is no obstacle, whatever the zero's sign.
  std::ofstream(folder / "zeros.csv") << "x,y,z\n0,0,0\n-0.0,0,0\n1e-20,0,0\n0,0,0\n";
  const Outcome done = filter("ball.urdf zeros.csv --joints slide=5.5 --out out");
  EXPECT_THAT(done.out, StartsWith("zeros.csv: 0 of 4 points are the robot, 3 are no return"));
  EXPECT_EQ(written("out/zeros.csv"), "x,y,z\n1e-20,0,0\n");
}

TEST_F(SelfFilterProgram, FailsInOneLine)
{
  expectFailure("ball.urdf a.csv", 2, "--out");
  expectFailure("ball.urdf a.csv --out out --joints slide", 2, "--joints: 'slide' is no joint with a value");
  expectFailure("ball.urdf a.csv --out out --joints elbow=1", 1, "joint 'elbow': is not one of ball");
  expectFailure("ball.urdf a.csv --out out --frame nose", 1, "link 'nose': is not one of ball");
  expectFailure("ball.urdf a.csv --out out --padding=-1", 2, "--padding");
  expectFailure("ball.urdf a.csv --out out --package arm", 2, "--package: 'arm' is no package with a folder");
  expectFailure("ball.urdf a.csv --out .", 2, "a.csv");
  expectFailure("none.urdf a.csv --out out", 1, "none.urdf: ");
  expectFailure("ball.urdf none.csv --out out", 1, "none.csv: ");
  std::filesystem::create_directory(folder / "twice");
  std::ofstream(folder / "twice/a.csv") << "x,y,z\n0,0,0\n";
  expectFailure("ball.urdf a.csv twice/a.csv --out out", 2, "a.csv");
  std::ofstream(folder / "states.csv") << "slide\n0\n1\n2\n";
  expectFailure("ball.urdf a.csv b.csv --states states.csv --out out", 2, "3 lines of values for 2 clouds");
  std::ofstream(folder / "bare.urdf") << "<robot name=\"bare\"><link name=\"a\"/></robot>";
  expectFailure("bare.urdf a.csv --out out", 1, "robot 'bare': has no body");
  for (const auto& [mesh, message] :
       {std::pair("m.las", "m.las: is no file of a mesh that is read: save it as .stl, .obj, .ply"),
        std::pair("m.DAE", "m.DAE: is ")}) {
    std::ofstream(folder / mesh) << "no mesh";
    std::ofstream(folder / "mesh.urdf") << "<robot name=\"m\"><link name=\"a\"><visual><geometry><mesh filename=\""
                                        << mesh << "\"/></geometry></visual></link></robot>";
    expectFailure("mesh.urdf a.csv --out out", 1, message);
  }
  self_filter::writeMadeRobot(folder.path());
  expectFailure("robot.urdf a.csv --out out --report meshes/forearm.stl", 2,
                "--report: meshes/forearm.stl: is the file of mesh of link 'forearm', which is read");
  std::ofstream(folder / "forearm.stl") << written("meshes/forearm.stl");
  expectFailure("robot.urdf forearm.stl --out meshes", 2, "--out: meshes/forearm.stl: is the file of mesh of link");
  std::filesystem::remove(folder / "meshes/forearm.stl");
  expectFailure("robot.urdf a.csv --out out", 1,
                "robot.urdf: link 'forearm' has the mesh meshes/forearm.stl, which is not there");
}

TEST_F(SelfFilterProgram, MadeRobotIsMadeAlike)
{
  for (const char* name : {"one", "two"})
    EXPECT_EQ(run("pcl_bsh_made_robot", std::string(name) + " --frames 1", folder.path()).exit_code, 0);
  for (const char* name : {"robot.urdf", "states.csv", "frame_000.pcd", "meshes/forearm.stl"})
    EXPECT_EQ(written(std::string("one/") + name), written(std::string("two/") + name)) << name;
  EXPECT_EQ(filter("one/robot.urdf one/frame_000.pcd --states one/states.csv --frame camera --out free").exit_code, 0);
  const auto points = [&](const char* name) {
    const pcl::PCLPointCloud2 cloud = io::readCloud(folder / name);
    return cloud.width * cloud.height;
  };
  EXPECT_EQ(points("one/frame_000.pcd"), 640U * 480);
  EXPECT_LT(points("free/frame_000.pcd"), 300'000U);
}

} // namespace
} // namespace pcl_bsh
