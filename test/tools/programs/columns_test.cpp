// SPDX-License-Identifier: BSD-3-Clause
// Every program that reads clouds takes names for the columns of text files, and warns where a number passes for x.
#include "program_run.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <gmock/gmock.h>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::Not;

class Columns : public testing::Test {
protected:
  Columns()
  {
    // Read as x y z, the points of both are elsewhere.
    std::string numbered, ordered;
    for (int i = 0; i < 20; ++i) {
      const std::string place = std::to_string(0.1 * i) + " " + std::to_string(0.01 * (i % 3)) + " 0.5";
      numbered += std::to_string(i + 1) + " " + place + "\n";
      ordered += "tree " + place + "\n"; // the first column is no number at all
    }
    folder.write("scan.xyz", numbered);
    folder.write("named.txt", ordered);
    io::writeCloud(folder / "obstacle.pcd", io::readCloud(folder / "scan.xyz", nullptr, {"_", "x", "y", "z"}));
  }

  Outcome runHere(const std::string& program, const std::string& arguments) const
  {
    return run(program, arguments, folder.path());
  }

  /// The program warns without names, and not with them.
  void expectTaken(const std::string& program, const std::string& arguments, const std::string& command = "") const
  {
    const Outcome without = runHere(program, command + arguments);
    EXPECT_EQ(without.exit_code, 0) << without.err;
    EXPECT_THAT(without.err, HasSubstr("warning: scan.xyz: its first column counts up by one")) << program;
    std::filesystem::remove_all(folder / "site");
    const Outcome with = runHere(program, command + "--columns _,x,y,z " + arguments);
    EXPECT_EQ(with.exit_code, 0) << with.err;
    EXPECT_THAT(with.err, Not(HasSubstr("warning"))) << program;
    const Outcome damaged = runHere(program, command + "--columns _,x,,z " + arguments);
    EXPECT_EQ(damaged.exit_code, 2);
    EXPECT_THAT(damaged.err, HasSubstr("--columns: _,x,,z: has a column without a name: give one name")) << program;
  }

  io::TemporaryFolder folder;
};

TEST_F(Columns, OfCollide)
{
  expectTaken("pcl_bsh_collide", "scan.xyz obstacle.pcd out.pcd --clearance 0.001");
  const std::string command = "scan.xyz named.txt out.pcd --clearance 0.001 --columns named.txt=_,E,N,H ";
  EXPECT_THAT(runHere("pcl_bsh_collide", command).out, HasSubstr("0 of 20 points collide"));
  for (const char* own : {"--columns _,x,y,z", "--columns scan.xyz=_,x,y,z"})
    EXPECT_THAT(runHere("pcl_bsh_collide", command + own).out, HasSubstr("20 of 20 points collide")) << own;
  EXPECT_EQ(io::namesOf(io::readCloud(folder / "out.pcd")), "x y z collision");
  const Outcome elsewhere = runHere("pcl_bsh_collide", command + "--columns other.xyz=x,y,z");
  EXPECT_EQ(elsewhere.exit_code, 2);
  EXPECT_THAT(elsewhere.err, HasSubstr("names columns of other.xyz, which is not read"));
  const Outcome binary = runHere("pcl_bsh_collide", "obstacle.pcd scan.xyz out.pcd --clearance 1 --columns "
                                                    "obstacle.pcd=x,y,z");
  EXPECT_EQ(binary.exit_code, 1);
  EXPECT_THAT(binary.err, HasSubstr("obstacle.pcd: is a .pcd, which names its fields itself"));
}

TEST_F(Columns, OfAccuracy)
{
  expectTaken("pcl_bsh_accuracy", "scan.xyz obstacle.pcd --clearance 0.001 --repeat 1 --out study");
}

TEST_F(Columns, OfCertify)
{
  if (!std::filesystem::exists(PCL_BSH_PROGRAM_DIR "/pcl_bsh_certify")) GTEST_SKIP() << "built without CGAL";
  expectTaken("pcl_bsh_certify", "scan.xyz --sample 1 --fit box");
}

TEST_F(Columns, OfView)
{
  if (!std::filesystem::exists(PCL_BSH_PROGRAM_DIR "/pcl_bsh_view")) GTEST_SKIP() << "built without VTK";
  expectTaken("pcl_bsh_view", "scan.xyz --size 160x120 --screenshot out.png");
}

TEST_F(Columns, OfSites)
{
  expectTaken("pcl_bsh_site", "scan.xyz --out site", "make ");
  ASSERT_EQ(runHere("pcl_bsh_site", "make obstacle.pcd --out other").exit_code, 0);
  expectTaken("pcl_bsh_site", "other scan.xyz --clearance 0.001 --report report.json", "collide ");
}

TEST_F(Columns, OfScenes)
{
  for (const bool named : {false, true}) {
    folder.write("scene.json", std::string(R"({"clouds": {"scan": {"file": "scan.xyz")") +
                                   (named ? R"(, "columns": "_,x,y,z")" : "") +
                                   R"(}}, "objects": [{"name": "a", "cloud": "scan"}], "clearance": 0.05,
                                       "steps": 1, "dt": 0.1, "effects": {"any": true}})");
    const Outcome done = runHere("pcl_bsh_scene", "scene.json");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(done.err.find("counts up by one") == std::string::npos, named) << done.err;
  }
}

TEST_F(Columns, OfPipelines)
{
  for (const bool named : {false, true}) {
    folder.write("pipeline.json", std::string(R"([{"type": "readers.text", "filename": "scan.xyz")") +
                                      (named ? R"(, "columns": "_,x,y,z")" : "") + R"(}, "out.pcd"])");
    const Outcome done = runHere("pcl_bsh_pipeline", "pipeline.json");
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(done.err.find("counts up by one") == std::string::npos, named) << done.err;
    EXPECT_EQ(io::namesOf(io::readCloud(folder / "out.pcd")), named ? "x y z" : "x y z column_4");
  }
  folder.write("pipeline.json", R"([{"type": "readers.text", "filename": "scan.xyz", "columns": "x,,y"}, "out.pcd"])");
  const Outcome refused = runHere("pcl_bsh_pipeline", "pipeline.json");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("/0/columns: has a column without a name"));
}

} // namespace
} // namespace pcl_bsh
