// SPDX-License-Identifier: BSD-3-Clause
// How far may an arm go on, by what its camera sees?
//
//   pcl_bsh_made_robot FOLDER --frames 12 && pcl_bsh_watch FOLDER
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/robots/joint_values.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/tools/self_filter/separation_monitor.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>

using namespace pcl_bsh;

int main(int argc, char** argv)
try {
  if (argc != 2) return std::cerr << "usage: pcl_bsh_watch FOLDER\n", 2;
  const std::filesystem::path folder = argv[1];
  const robots::Robot arm = io::readRobot(folder / "robot.urdf");
  const std::vector<robots::JointValues> states = io::readJointStates(folder / "states.csv");

  robots::WorldOptions options;
  options.clearance = 0.05;  // m, from all points that are not the arm
  options.with_self = false; // the arm is not held against itself: that was planned
  self_filter::Settings arm_itself;
  arm_itself.padding = 0.02;                              // m: points within are the arm
  arm_itself.paddings = {{"base", 0.06}, {"mast", 0.06}}; // they stand on the floor
  self_filter::SeparationMonitor monitor(arm, arm_itself, options);
  for (std::size_t i = 0; i + 1 < states.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%03zu.pcd", i);
    const pcl::PCLPointCloud2 frame = io::readCloud(folder / name);
    const Eigen::Isometry3d T_world_camera = linkPoses(arm, states[i])[arm.linkNamed("camera")];
    const auto check =
        monitor.check(viewOf(frame), T_world_camera, stateOf(arm, states[i]), stateOf(arm, states[i + 1]));
    std::cout << name << ": go on until " << check.motion.last_valid << " of the motion; " << check.self << " of "
              << check.near << " near points are the arm\n";
  }
  return 0;
}
catch (const std::exception& error) {
  std::cerr << "pcl_bsh_watch: " << error.what() << '\n';
  return 1;
}
