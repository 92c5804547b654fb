// SPDX-License-Identifier: BSD-3-Clause
#include "io/clouds/samples.h"
#include "support/arm_problems.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/robot/robot_world.h>

#include <gmock/gmock.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace pcl_bsh::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path panda = fs::path(PCL_BSH_SHARED_DIR) / "data/arms/panda";

class ReadGroups : public testing::Test {
protected:
  ReadGroups()
  {
    std::string urdf = "<robot name=\"r\">";
    for (const char* link : {"a", "b", "c", "d"}) urdf += "<link name=\"" + std::string(link) + "\"/>";
    for (const auto& [parent, child] : {std::array{"a", "b"}, std::array{"b", "c"}, std::array{"c", "d"}})
      urdf += std::string("<joint name=\"to_") + child + "\" type=\"continuous\"><parent link=\"" + parent +
              "\"/><child link=\"" + child + "\"/></joint>";
    folder.write("r.urdf", urdf + "</robot>");
    robot = readRobot(folder / "r.urdf");
  }

  RobotGroups read(const std::string& text)
  {
    folder.write("r.srdf", text);
    return readGroups(folder / "r.srdf", robot);
  }

  const TemporaryFolder folder;
  robots::Robot robot;
};

TEST_F(ReadGroups, OfChainsLinksJointsAndGroups)
{
  const RobotGroups groups = read(R"(<robot name="r">
    <group name="arm"><chain base_link="a" tip_link="c"/></group>
    <group name="hand"><link name="d"/></group>
    <group name="all"><group name="arm"/><joint name="to_d"/><joint name="none"/></group>
    <group_state name="up" group="arm"><joint name="to_b" value="0.5"/><joint name="none" value="1"/></group_state>
    <disable_collisions link1="a" link2="c"/><disable_collisions link1="a" link2="none"/></robot>)");
  EXPECT_THAT(groups.joints.at("arm"), ElementsAre("to_b", "to_c"));
  EXPECT_THAT(groups.joints.at("hand"), ElementsAre("to_d"));
  EXPECT_THAT(groups.joints.at("all"), ElementsAre("to_b", "to_c", "to_d"));
  EXPECT_EQ(groups.states.at("up"), (robots::JointValues{{"to_b", 0.5}}));
  EXPECT_THAT(robot.disabled_pairs, ElementsAre(std::array<std::size_t, 2>{0, 2}));
}

TEST_F(ReadGroups, RefusesWhatIsNoSrdf)
{
  const auto refused = [&](const std::string& text) {
    try {
      read(text);
    }
    catch (const files::FileError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refused("<robot"), HasSubstr("r.srdf: is no XML"));
  EXPECT_THAT(refused("<map/>"), HasSubstr("has no element <robot>"));
  EXPECT_THAT(refused("<robot><group_state name='s'><joint name='to_b' value='x'/></group_state></robot>"),
              HasSubstr("joint 'to_b' of a state: 'x'"));
  EXPECT_THROW(readGroups(folder / "none.srdf", robot), files::FileError);
}

TEST(ReadMeshes, GivesLinksTheirSurfaces)
{
  const TemporaryFolder folder;
  folder.write("plate.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  folder.write("r.urdf", R"(<robot name="r"><link name="a"><collision><geometry><mesh filename="plate.off"
      scale="2 1 1"/></geometry></collision></link></robot>)");
  robots::Robot robot = readRobot(folder / "r.urdf");
  readMeshes(robot);
  const std::array<double, 3> point = {1.5, 0.1, 0.25};
  const SphereHierarchy cloud(viewOf(point.data(), 1));
  EXPECT_NEAR(robots::RobotWorld(robot, {&cloud}).clearance({}).gap.lower, 0.25, 1e-6);
}

/// Free motions are free at 1,025 samples.
TEST(Panda, MotionsAmongShelvesAreCertified)
{
  const std::vector<test::ArmProblem> problems = test::armProblems(panda / "problems.txt");
  if (problems.empty()) GTEST_SKIP() << "no data";
  robots::Robot arm = readRobot(panda / "panda_spherized.urdf");
  const RobotGroups groups = readGroups(panda / "panda.srdf", arm);
  EXPECT_EQ(groups.joints.at("panda_arm").size(), 7u);
  test::Random random(5);
  std::array<int, 3> seen = {};
  for (std::size_t i = 0; i < problems.size(); i += 25) {
    const std::vector<float> xyz = problems[i].cloud(1000, random);
    const std::vector<float> radii(xyz.size() / 3, 0.0025f);
    PointsView view = viewOf(xyz.data(), radii.size());
    view.radii = radii.data();
    const SphereHierarchy cloud(view);
    const robots::RobotWorld world(arm, {&cloud});
    for (int motion = 0; motion < 10; ++motion) {
      robots::RobotState from, to;
      for (const std::size_t link : variablesOf(arm)) {
        const robots::Joint& joint = *arm.links[link].joint;
        from.push_back(random.uniform(joint.lower, joint.upper));
        const double goal = random.uniform(joint.lower, joint.upper);
        to.push_back(from.back() + 0.25 * (goal - from.back()));
      }
      const robots::MotionCheck check = world.checkMotion(from, to);
      ++seen[static_cast<std::size_t>(check.verdict)];
      for (int sample = 0; sample <= 1024 && check.verdict == Verdict::free; ++sample) {
        robots::RobotState state = from;
        for (std::size_t k = 0; k < state.size(); ++k) state[k] += sample / 1024.0 * (to[k] - from[k]);
        ASSERT_EQ(world.checkState(state).verdict, Verdict::free) << problems[i].name << " " << sample;
      }
    }
  }
  EXPECT_GT(seen[0], 40);
  EXPECT_GT(seen[1], 20);
  EXPECT_EQ(seen[2], 0);
}

} // namespace
} // namespace pcl_bsh::io
