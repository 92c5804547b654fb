// SPDX-License-Identifier: BSD-3-Clause
// Any text as a URDF, as an SRDF beside a small robot, and as values of joints: refused with a reason of one line, or a
// robot whose links have finite places that are rigid.
#include "refusal.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/robots/joint_values.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/robot/kinematics.h>

#include <filesystem>

namespace {

using namespace pcl_bsh;

void requirePlaces(const robots::Robot& robot)
{
  const robots::Kinematics kinematics(robot);
  for (const double value : {0.0, 0.5}) {
    const robots::RobotState state(kinematics.variables(), value);
    for (const Eigen::Isometry3d& pose : kinematics.linkPoses(state)) {
      const Eigen::Matrix3d error = pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity();
      fuzz::require(pose.matrix().allFinite() && error.norm() <= 1e-9, "a place that is not rigid");
    }
  }
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static const files::TemporaryFolder folder;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::filesystem::path file = folder.write("fuzzed", text);
  fuzz::mayRefuse([&] { requirePlaces(io::readRobot(file)); });
  fuzz::mayRefuse([&] {
    robots::Robot robot;
    for (const char* name : {"base", "arm", "hand"}) robot.links.push_back({name, {}, {}});
    for (const std::size_t link : {std::size_t{1}, std::size_t{2}})
      robot.links[link].joint = robots::Joint{link == 1 ? "joint" : "wrist", robots::Joint::Kind::continuous, link - 1};
    const io::RobotGroups groups = io::readGroups(file, robot);
    for (const auto& state : groups.states) fuzz::mayRefuse([&] { robot.requireValues(state.second); });
    for (const auto& pair : robot.disabled_pairs)
      fuzz::require(pair[0] < robot.links.size() && pair[1] < robot.links.size(), "a pair of no link");
  });
  fuzz::mayRefuse([&] { io::parseJointValues(text); });
  fuzz::mayRefuse([&] { io::readJointStates(file); });
  return 0;
}
