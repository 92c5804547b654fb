// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/self_filter/separation_monitor.h>

#include "support/refusal.h"
#include "tools/programs/program_run.h"
#include <examples/robot/made_robot.h>
#include <pcl_bsh/io/robots/read_robot.h>

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using namespace self_filter;

class SeparationMonitorTest : public testing::Test {
protected:
  SeparationMonitorTest()
  {
    writeMadeRobot(folder.path());
    robot = io::readRobot(folder / "robot.urdf");
    options.clearance = 0.05;
    options.with_self = false;
  }

  Eigen::Isometry3d cameraPose(const JointValues& values) const
  {
    return options.base * linkPoses(robot, values)[robot.linkNamed("camera")];
  }

  const io::TemporaryFolder folder;
  Robot robot;
  robots::WorldOptions options;
  const Settings settings{0.02, 1, {{"base", 0.06}, {"mast", 0.06}}}; ///< they stand on the floor
};

/// The whole frame, without the robot, as an obstacle from the start, is the same question.
TEST_F(SeparationMonitorTest, AnswersAsTheWholeFrameDoes)
{
  options.base.translation() = Eigen::Vector3d(0.5, -2, 0.25);
  SeparationMonitor monitor(robot, settings, options);
  SelfFilter filter(robot, settings);
  Robot with_meshes = robot;
  io::readMeshes(with_meshes);
  std::array<int, 3> seen = {};
  for (std::size_t i = 0; i < 8; ++i) {
    const JointValues values = madeJointValues(i, 8);
    const robots::RobotState now = stateOf(robot, values);
    robots::RobotState next = stateOf(robot, madeJointValues(i + 1, 8));
    if (i % 2 == 1) next[1] += 0.5; // towards the table
    const DepthImage image = seenBy(robot, values, 160);
    const PointsView frame = viewOf(image.xyz.data(), image.is_robot.size());
    const Eigen::Isometry3d T_world_camera = cameraPose(values);
    const SeparationCheck check = monitor.check(frame, T_world_camera, now, next);

    const std::vector<Verdict>& flags = filter.flags(frame, T_world_camera.inverse() * options.base, values);
    std::vector<std::int32_t> others;
    for (std::uint32_t k = 0; k < frame.count; ++k)
      if (flags[k] == Verdict::free && isFinite(frame.point(k))) others.push_back(static_cast<std::int32_t>(k));
    PointsView rest = frame;
    rest.restrictTo(others.data(), others.size());
    const SphereHierarchy obstacle(rest);
    robots::RobotWorld world(with_meshes, {&obstacle}, options);
    world.setObstaclePoses({T_world_camera});
    const robots::MotionCheck expected = world.checkMotion(now, next, true);
    ++seen[static_cast<std::size_t>(expected.verdict)];
    EXPECT_EQ(check.motion.verdict, expected.verdict) << i;
    EXPECT_NEAR(check.motion.last_valid, expected.last_valid, 1e-3) << i;
    EXPECT_GT(check.self, 100U);
    EXPECT_LT(check.near, frame.count / 2);
    if (check.motion.meeting && check.motion.verdict == Verdict::colliding) {
      EXPECT_NE(flags[check.motion.meeting->record], Verdict::colliding);
    }
  }
  EXPECT_GT(seen[0], 1);
  EXPECT_GT(seen[1], 1);
}

TEST_F(SeparationMonitorTest, SeesWhatComesAndGoes)
{
  const JointValues values = madeJointValues(0, 8);
  const robots::RobotState now = stateOf(robot, values), next = stateOf(robot, madeJointValues(1, 8));
  DepthImage image = seenBy(robot, values, 160);
  const PointsView frame = viewOf(image.xyz.data(), image.is_robot.size());
  const Eigen::Isometry3d T_world_camera = cameraPose(values);
  SeparationMonitor monitor(robot, settings, options);
  const double before = monitor.check(frame, T_world_camera, now, next).motion.last_valid;
  EXPECT_GT(before, 0.0);
  // A hand beside the robot's, 4 cm from it.
  const std::vector<Eigen::Isometry3d> poses = linkPoses(robot, values);
  const Eigen::Vector3d hand =
      T_world_camera.inverse() * (poses[robot.linkNamed("hand")] * Eigen::Vector3d(0.025, 0.08 + 0.04, 0.0));
  for (int axis = 0; axis < 3; ++axis) image.xyz[static_cast<std::size_t>(axis)] = static_cast<float>(hand[axis]);
  const SeparationCheck check = monitor.check(frame, T_world_camera, now, next);
  EXPECT_EQ(check.motion.verdict, Verdict::colliding);
  EXPECT_EQ(check.motion.last_valid, 0.0);
  image.xyz[0] = image.xyz[1] = image.xyz[2] = 0.0f; // no return
  EXPECT_EQ(monitor.check(frame, T_world_camera, now, next).motion.last_valid, before);
}

TEST_F(SeparationMonitorTest, HasAnExample)
{
  ASSERT_EQ(run("pcl_bsh_made_robot", "made --frames 3", folder.path()).exit_code, 0);
  const Outcome done = run("pcl_bsh_watch", "made", folder.path());
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out,
              testing::MatchesRegex("frame_000.pcd: go on until .* near points are the arm\nframe_001.pcd: .*\n"));
  EXPECT_EQ(run("pcl_bsh_watch", "none", folder.path()).exit_code, 1);
}

TEST_F(SeparationMonitorTest, RefusesAndGoesOn)
{
  SeparationMonitor monitor(robot, settings, options);
  const std::vector<float> xyz = {5, 5, 5};
  const PointsView frame = viewOf(xyz.data(), 1);
  const robots::RobotState now = stateOf(robot, madeJointValues(0, 8));
  Eigen::Isometry3d bent = Eigen::Isometry3d::Identity();
  bent.linear() *= 2.0;
  EXPECT_THAT(test::refusalOf([&] { monitor.check(frame, bent, now, now); }), testing::HasSubstr("T_world_cloud"));
  EXPECT_THAT(test::refusalOf([&] { monitor.check(frame, Eigen::Isometry3d::Identity(), now, {}); }),
              testing::HasSubstr("has 0 values"));
  const SeparationCheck check = monitor.check(frame, Eigen::Isometry3d::Identity(), now, now);
  EXPECT_EQ(check.motion.verdict, Verdict::free);
  EXPECT_EQ(check.near, 0U);
}

} // namespace
} // namespace pcl_bsh
