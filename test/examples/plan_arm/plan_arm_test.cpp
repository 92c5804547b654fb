// SPDX-License-Identifier: BSD-3-Clause
#include "tools/programs/program_run.h"
#include <examples/robot/made_robot.h>

#include <pcl_bsh/io/robots/joint_values.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/io/robots/surface.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/robot/robot_world.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using robots::RobotState;
using testing::HasSubstr;
using testing::StartsWith;

/// The made robot is to reach from one side of a post to the other.
class PlanArm : public testing::Test {
protected:
  PlanArm()
  {
    self_filter::writeMadeRobot(folder.path());
    folder.write("robot.srdf",
                 R"(<robot name="made_arm"><disable_collisions link1="upper_arm" link2="forearm"/></robot>)");
    std::string table = "x,y,z\n";
    for (int i = 0; i < 50; ++i) {
      post.insert(post.end(), {0.6f, 0.0f, 0.02f * static_cast<float>(i)});
      table += "0.6,0," + std::to_string(post.back()) + '\n';
    }
    folder.write("post.csv", table);
    folder.write("states.csv", "turn,shoulder,bend,grip\n-0.7,0.5,1.2,0.03\n0.7,0.5,1.2,0.03\n");
    folder.write("at_post.csv", "turn,shoulder,bend,grip\n-0.7,0.5,1.2,0.03\n0,0.5,1.2,0.03\n");
  }

  Outcome plan(const std::string& arguments) const { return run("pcl_bsh_plan_arm", arguments, folder.path()); }

  /// One line, the code, and nothing written.
  void expectFailure(const std::string& arguments, int exit_code, const std::string& message) const
  {
    const std::size_t files = folder.files();
    const Outcome failed = plan(arguments);
    EXPECT_EQ(failed.exit_code, exit_code) << arguments;
    EXPECT_THAT(failed.err, StartsWith("pcl_bsh_plan_arm: ")) << arguments;
    EXPECT_THAT(failed.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_EQ(failed.out, "");
    EXPECT_EQ(folder.files(), files) << arguments;
  }

  const io::TemporaryFolder folder;
  std::vector<float> post;
};

TEST_F(PlanArm, WritesACertifiedPath)
{
  const Outcome done = plan("robot.urdf robot.srdf post.csv states.csv path.csv --clearance 0.03");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, StartsWith("certified: "));
  const std::string asked = "robot.urdf post.csv --srdf robot.srdf --motions --clearance 0.03 --states ";
  const Outcome checked = run("pcl_bsh_arm", asked + "path.csv", folder.path());
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("motion 0 to 1: free"));
  for (const char* word : {"colliding", "undecided"})
    EXPECT_EQ(checked.out.find(word), std::string::npos) << checked.out;
  EXPECT_THAT(run("pcl_bsh_arm", asked + "states.csv", folder.path()).out, HasSubstr("motion 0 to 1: colliding"));
}

/// At 200 instants of each motion, by the world and by triangles of the bodies' surfaces.
TEST_F(PlanArm, IsFreeAtEachInstant)
{
  ASSERT_EQ(plan("robot.urdf robot.srdf post.csv states.csv path.csv --clearance 0.03").exit_code, 0);
  robots::Robot arm = io::readRobot(folder / "robot.urdf");
  io::readGroups(folder / "robot.srdf", arm);
  io::readMeshes(arm);
  const SphereHierarchy points(viewOf(post.data(), post.size() / 3));
  const robots::RobotWorld world(arm, {&points}, {0.03});
  std::deque<io::Surface> surfaces;
  std::vector<std::pair<std::size_t, std::unique_ptr<SphereHierarchy>>> bodies;
  for (std::size_t link = 0; link < arm.links.size(); ++link)
    for (const robots::Shape& shape : arm.links[link].shapes) {
      surfaces.push_back(io::surfaceOf(shape, 0.0005));
      bodies.emplace_back(link, std::make_unique<SphereHierarchy>(surfaces.back().view()));
    }

  std::vector<RobotState> path;
  for (const robots::JointValues& values : io::readJointStates(folder / "path.csv"))
    path.push_back(stateOf(arm, values));
  const std::vector<robots::JointValues> asked = io::readJointStates(folder / "states.csv");
  ASSERT_GE(path.size(), 3u);
  EXPECT_EQ(path.front(), stateOf(arm, asked.front()));
  EXPECT_EQ(path.back(), stateOf(arm, asked.back()));
  const std::vector<std::size_t> variables = variablesOf(arm);
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
    for (int sample = 0; sample <= 200; ++sample) {
      RobotState state = path[k];
      for (std::size_t i = 0; i < state.size(); ++i) {
        double way = path[k + 1][i] - path[k][i];
        if (arm.links[variables[i]].joint->kind == robots::Joint::Kind::continuous)
          way = std::remainder(way, 2 * std::numbers::pi);
        state[i] += sample / 200.0 * way;
      }
      ASSERT_EQ(world.checkState(state).verdict, Verdict::free) << k << ' ' << sample;
      const std::vector<Eigen::Isometry3d> poses = world.kinematics().linkPoses(state);
      for (const auto& [link, body] : bodies)
        ASSERT_EQ(anyCollision({*body, poses[link]}, {points}, {0.03}).verdict, Verdict::free) << k << ' ' << sample;
    }
}

TEST_F(PlanArm, TellsWhatIsWrong)
{
  const std::string rest = " --clearance 0.03";
  expectFailure("robot.urdf robot.srdf post.csv at_post.csv path.csv" + rest, 1,
                "at_post.csv: its last state is not free");
  expectFailure("robot.urdf robot.srdf post.csv states.csv path.csv --seconds 0" + rest, 1, "no path is found in 0 s");
  expectFailure("robot.urdf robot.srdf none.csv states.csv path.csv" + rest, 1, "none.csv");
  expectFailure("robot.urdf robot.srdf post.csv states.csv states.csv" + rest, 2, "states.csv");
  expectFailure("robot.urdf robot.srdf post.csv states.csv path.csv --clearance -1", 2, "--clearance");
  expectFailure("robot.urdf post.csv", 2, "FILE");
}

} // namespace
} // namespace pcl_bsh
