// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/program_run.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;

/// A ball of radius 0.1, 1 m from the axis that it turns about, and two points beside its way.
class ArmProgram : public testing::Test {
protected:
  ArmProgram()
  {
    folder.write("arm.urdf", R"(<robot name="arm"><link name="base"/><link name="bob"><collision>
      <origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
      <joint name="turn" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 0 1"/></joint></robot>)");
    folder.write("arm.srdf",
                 R"(<robot name="arm"><group_state name="up"><joint name="turn" value="1"/></group_state></robot>)");
    folder.write("points.csv", "x,y,z\n0,0,9\n0,1.15,0\n");
    folder.write("states.csv", "turn\n0\n1\n2\n");
  }

  Outcome arm(const std::string& arguments) const { return run("pcl_bsh_arm", arguments, folder.path()); }

  void expectFailure(const std::string& arguments, int exit_code, const std::string& message) const
  {
    const Outcome failed = arm(arguments);
    EXPECT_EQ(failed.exit_code, exit_code) << arguments;
    EXPECT_THAT(failed.err, StartsWith("pcl_bsh_arm: ")) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
  }

  const io::TemporaryFolder folder;
};

TEST_F(ArmProgram, WritesATableOfAnyNumberOfThreads)
{
  std::string states = "turn\n";
  for (int i = 0; i < 300; ++i) states += std::to_string(0.1 * i) + '\n';
  folder.write("many.csv", states);
  const std::string asked = "arm.urdf points.csv --states many.csv --motions --clearance 0.06 --table ";
  ASSERT_EQ(arm(asked + "one.csv").exit_code, 0);
  const Outcome done = arm(asked + "two.csv --threads 2 --report report.json");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const std::string table = io::contentOf(folder / "one.csv");
  EXPECT_EQ(table, io::contentOf(folder / "two.csv"));
  EXPECT_THAT(table, StartsWith("what,number,verdict,gap_lower,gap_upper,fraction,last_valid,link,other_link,obstacle,"
                                "record,x,y,z\nstate,0,free,"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 600);
  const Json report = Json::parse(io::contentOf(folder / "report.json"));
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  for (const auto& [what, key] : {std::pair("state", "states"), std::pair("motion", "motions")})
    for (std::size_t i = 0; i < report[key].size(); ++i) {
      std::getline(lines, line);
      EXPECT_THAT(line, StartsWith(std::string(what) + ',' + std::to_string(i) + ',' +
                                   report[key][i]["verdict"].get<std::string>() + ','));
      EXPECT_EQ(std::count(line.begin(), line.end(), ','), 13) << line;
      EXPECT_EQ(line.find(",bob,,points.csv,1,0,1.15,0") != line.npos, report[key][i].contains("place")) << line;
    }
  expectFailure("arm.urdf points.csv --states states.csv --table none/a.csv", 1, "none");
}

TEST_F(ArmProgram, AnswersForUncertainPointsAndJoints)
{
  folder.write("beside.csv", "turn\n1.5707963267948966\n");
  const std::string asked = "arm.urdf points.csv --states beside.csv --clearance 0.06"; // the gap is 0.05
  EXPECT_THAT(arm(asked).out, StartsWith("state 0: colliding: bob with point 1"));
  EXPECT_THAT(arm(asked + " --uncertainty 0.02").out, StartsWith("state 0: undecided: bob with point 1"));
  EXPECT_THAT(arm(asked + " --uncertainty 0.005 --joint-uncertainty 0.004").out, StartsWith("state 0: colliding"));
  EXPECT_THAT(arm(asked + " --uncertainty 0.005 --joint-uncertainty 0.006").out, StartsWith("state 0: undecided"));
  expectFailure(asked + " --joint-uncertainty -1", 2, "--joint-uncertainty");
  expectFailure(asked + " --joint-uncertainty 0.1,0.1", 1, "joint_uncertainties: are 2: give one for each of the 1");
}

TEST_F(ArmProgram, TellsWhatCollidesWhereAndWhen)
{
  const Outcome done = arm("arm.urdf points.csv --states states.csv --motions --clearance 0.06 --report report.json");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("motion 0 to 1: free\n"));
  EXPECT_THAT(done.out, HasSubstr("bob with point 1 of points.csv; free until 0."));
  const Json report = Json::parse(io::contentOf(folder / "report.json"));
  ASSERT_EQ(report["motions"].size(), 2u);
  EXPECT_EQ(report["motions"][1]["verdict"], "colliding");
  EXPECT_EQ(report["motions"][1]["link"], "bob");
  EXPECT_EQ(report["motions"][1]["point"], 1);
  EXPECT_NEAR(report["motions"][1]["fraction"].get<double>(), 0.57, 0.05);
  EXPECT_EQ(report["states"][0]["verdict"], "free");
  EXPECT_EQ(arm("arm.urdf points.csv --states states.csv --motions --clearance 0.04").out.find("colliding"),
            std::string::npos);
  EXPECT_THAT(arm("arm.urdf points.csv --states states.csv --motions --radius 0.06").out, HasSubstr("colliding"));
}

TEST_F(ArmProgram, TakesStatesOfAnSrdfAndABase)
{
  EXPECT_THAT(arm("arm.urdf points.csv --srdf arm.srdf --state up --base=0,0.31,0,0,0,0").out, HasSubstr("free"));
  EXPECT_THAT(arm("arm.urdf points.csv --srdf arm.srdf --state up --base=-0.54,0.31,0,0,0,0").out,
              HasSubstr("state 0: colliding: bob with point 1"));
}

TEST_F(ArmProgram, RefusesWhatIsWrong)
{
  expectFailure("arm.urdf --joints trun=1", 1, "joint 'trun': is not one of arm");
  expectFailure("arm.urdf --joints turn", 2, "'turn' is no joint with a value");
  expectFailure("arm.urdf --state up", 2, "give --srdf");
  expectFailure("arm.urdf --srdf arm.srdf --state down", 2, "has no state 'down'");
  expectFailure("arm.urdf --clearance -1", 2, "--clearance");
  expectFailure("none.urdf", 1, "none.urdf");
  expectFailure("arm.urdf none.pcd", 1, "none.pcd");
}

} // namespace
} // namespace pcl_bsh
