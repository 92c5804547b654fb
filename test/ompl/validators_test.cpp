// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/ompl/validators.h>

#include <gmock/gmock.h>

#include <ompl/base/ScopedState.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <cmath>
#include <memory>
#include <vector>

namespace pcl_bsh {
namespace {

namespace ob = ::ompl::base;
using namespace robots;

/// A plane arm of two links, each a capsule of 0.8 m, among a wall of points with a hole.
class OmplValidators : public testing::Test {
protected:
  OmplValidators()
  {
    ::ompl::msg::setLogLevel(::ompl::msg::LOG_ERROR);
    Robot robot{"arm", {{"base", {}, {}}}};
    for (std::size_t i = 0; i < 2; ++i) {
      Joint joint{i == 0 ? "shoulder" : "elbow", Joint::Kind::revolute, i};
      joint.axis = Eigen::Vector3d::UnitZ();
      joint.origin.translation() = Eigen::Vector3d(i == 0 ? 0.0 : 1.0, 0, 0);
      joint.lower = -3, joint.upper = 3;
      Shape rod{Capsule{0.05, 0.8}};
      rod.pose.translation() = Eigen::Vector3d(0.5, 0, 0);
      rod.pose.linear() = Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitY()).toRotationMatrix();
      robot.links.push_back({joint.name, {rod}, joint});
    }
    for (double x = 1.2; x < 2.2; x += 0.05) xyz.insert(xyz.end(), {x, 0.0, 0.0});
    cloud = std::make_unique<SphereHierarchy>(viewOf(xyz.data(), xyz.size() / 3));
    world = std::make_shared<RobotWorld>(robot, std::vector<const SphereHierarchy*>{cloud.get()}, WorldOptions{0.03});
    space = std::make_shared<ob::RealVectorStateSpace>(2);
    space->setBounds(-3, 3);
  }

  std::vector<double> xyz;
  std::unique_ptr<SphereHierarchy> cloud;
  std::shared_ptr<const RobotWorld> world;
  std::shared_ptr<ob::RealVectorStateSpace> space;
};

TEST_F(OmplValidators, PlansWhatIsCertified)
{
  ::ompl::RNG::setSeed(1);
  ::ompl::geometric::SimpleSetup setup(space);
  const ob::SpaceInformationPtr& information = setup.getSpaceInformation();
  setup.setStateValidityChecker(std::make_shared<pcl_bsh::ompl::StateValidity>(information, world));
  information->setMotionValidator(std::make_shared<pcl_bsh::ompl::MotionValidity>(information, world));
  setup.setPlanner(std::make_shared<::ompl::geometric::RRTConnect>(information));
  ob::ScopedState<ob::RealVectorStateSpace> start(space), goal(space);
  start[0] = -0.6, start[1] = 0.0;
  goal[0] = 0.6, goal[1] = 0.0;
  setup.setStartAndGoalStates(start, goal);
  EXPECT_FALSE(information->checkMotion(start.get(), goal.get()));
  ASSERT_EQ(setup.solve(20.0), ob::PlannerStatus::EXACT_SOLUTION);
  setup.simplifySolution();
  const std::vector<ob::State*>& path = setup.getSolutionPath().getStates();
  ASSERT_GE(path.size(), 3u);
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    EXPECT_EQ(world->checkMotion(pcl_bsh::ompl::valuesOf(path[i], 2), pcl_bsh::ompl::valuesOf(path[i + 1], 2)).verdict,
              Verdict::free);
}

TEST_F(OmplValidators, TellsTheLastValidState)
{
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  const pcl_bsh::ompl::MotionValidity motions(information, world);
  const pcl_bsh::ompl::StateValidity states(information, world);
  ob::ScopedState<ob::RealVectorStateSpace> from(space), to(space), last(space);
  from[0] = -0.6, from[1] = 0.0;
  to[0] = 0.6, to[1] = 0.0;
  std::pair<ob::State*, double> found(last.get(), -1.0);
  EXPECT_FALSE(motions.checkMotion(from.get(), to.get(), found));
  EXPECT_GT(found.second, 0.4);
  EXPECT_LT(found.second, 0.5);
  EXPECT_NEAR(last[0], -0.6 + 1.2 * found.second, 1e-12);
  EXPECT_TRUE(states.isValid(from.get()));
  EXPECT_NEAR(states.clearance(last.get()), 0.0, 1e-3);
  to[0] = 3.5; // out of its limits
  EXPECT_FALSE(states.isValid(to.get()));
  EXPECT_FALSE(motions.checkMotion(from.get(), to.get()));
}

} // namespace
} // namespace pcl_bsh
