// SPDX-License-Identifier: BSD-3-Clause
// To copy from: OMPL plans a motion of an arm among the points of a scan, and each instant of the path is certified.
#include <pcl_bsh/ompl/joint_space.h>
#include <pcl_bsh/ompl/validators.h>
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/robots/joint_values.h>
#include <pcl_bsh/io/robots/read_robot.h>
#include <pcl_bsh/io/text/number_text.h>

#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <iostream>

using namespace pcl_bsh;
namespace og = ::ompl::geometric;

/// @param files the robot, its SRDF, the scan, the states of which the first and the last are start and goal, the path
static int plan(const std::vector<std::string>& files, double clearance, double seconds)
{
  cli::CommandFiles used;
  for (std::size_t i = 0; i < 4; ++i) used.reads("FILE " + std::to_string(i + 1), files[i]);
  used.writes("FILE 5", files[4]).requireApart();
  robots::Robot arm = io::readRobot(files[0]);
  io::readGroups(files[1], arm);
  io::readMeshes(arm);
  const io::Obstacle read = io::readObstacle(files[2], {});
  const SphereHierarchy scan(read.view());
  const auto world =
      std::make_shared<const robots::RobotWorld>(arm, std::vector{&scan}, robots::WorldOptions{clearance});

  ::ompl::msg::setLogLevel(::ompl::msg::LOG_NONE);
  ::ompl::RNG::setSeed(1); // the same path again
  og::SimpleSetup setup(std::make_shared<pcl_bsh::ompl::JointSpace>(arm));
  const auto& information = setup.getSpaceInformation();
  setup.setStateValidityChecker(std::make_shared<pcl_bsh::ompl::StateValidity>(information, world));
  information->setMotionValidator(std::make_shared<pcl_bsh::ompl::MotionValidity>(information, world));
  setup.setPlanner(std::make_shared<og::RRTConnect>(information));
  const auto free = [&](const robots::JointValues& values, const std::string& which) {
    ::ompl::base::ScopedState<> state(setup.getStateSpace());
    state = stateOf(arm, values);
    if (world->checkState(state.reals()).verdict != Verdict::free)
      throw std::runtime_error(files[3] + ": its " + which + " state is not free: ask pcl_bsh_arm what collides");
    state.enforceBounds(); // of continuous joints
    return state;
  };
  const std::vector<robots::JointValues> states = io::readJointStates(files[3]);
  setup.setStartAndGoalStates(free(states.front(), "first"), free(states.back(), "last"));
  if (setup.solve(seconds) != ::ompl::base::PlannerStatus::EXACT_SOLUTION)
    throw std::runtime_error("no path is found in " + io::numberText(seconds) + " s: give more --seconds");

  og::PathGeometric path = setup.getSolutionPath();
  setup.simplifySolution();
  if (setup.getSolutionPath().check()) path = setup.getSolutionPath(); // simplifying cuts motions without asking
  if (!path.check()) throw std::runtime_error("a path is found and not certified: give another --clearance");
  std::string table;
  for (const std::size_t link : variablesOf(arm)) table += arm.links[link].joint->name + ',';
  for (const ::ompl::base::State* state : path.getStates()) {
    table.back() = '\n'; // in place of a comma
    for (const double value : pcl_bsh::ompl::valuesOf(state, variablesOf(arm).size()))
      table += io::numberText(value) + ',';
  }
  table.back() = '\n';
  files::replaceFile(files[4], [&](std::ostream& out) { out << table; });
  std::cout << "certified: " << path.getStateCount() - 1 << " motions; length " << path.length() << " rad or m\n";
  return 0;
}

int main(int argc, char** argv)
{
  constexpr auto program = "pcl_bsh_plan_arm";
  return cli::runProgram(program, [&] {
    std::vector<std::string> files;
    double clearance = 0.0, seconds = 30.0;
    CLI::App app("Plans a certified motion of an arm among the points of a scan.", program);
    app.add_option("FILE", files, "ROBOT.urdf ROBOT.srdf SCAN STATES.csv PATH.csv")->expected(5)->required();
    const auto positive = cli::number<double>("give a number >= 0", [](double given) { return given >= 0.0; });
    app.add_option("--clearance", clearance, "from the scan's points, m")->transform(positive);
    app.add_option("--seconds", seconds, "for planning")->transform(positive)->capture_default_str();
    return cli::understood(app, program, argc, argv) ? plan(files, clearance, seconds) : 0;
  });
}
