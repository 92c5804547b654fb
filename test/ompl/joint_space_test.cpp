// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/ompl/joint_space.h>

#include "support/refusal.h"

#include <gmock/gmock.h>

#include <ompl/base/ScopedState.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using State = ::ompl::base::ScopedState<>;
using namespace robots;
using testing::StartsWith;

/// A joint that turns on and on, one with limits, one that is fixed, and one that mimics.
Robot madeRobot()
{
  Robot robot{"robot", {{"base", {}, {}}}};
  for (const auto& [name, kind] :
       {std::pair("wheel", Joint::Kind::continuous), std::pair("lift", Joint::Kind::prismatic),
        std::pair("seat", Joint::Kind::fixed), std::pair("mirror", Joint::Kind::revolute)}) {
    Joint joint{name, kind, 0};
    joint.lower = -0.5, joint.upper = 1.5;
    robot.links.push_back({name, {}, joint});
  }
  robot.links.back().joint->mimic = Mimic{"wheel"};
  return robot;
}

class JointSpace : public testing::Test {
protected:
  State state(double wheel, double lift) const
  {
    State state(space);
    state[0] = wheel, state[1] = lift;
    return state;
  }

  const std::shared_ptr<pcl_bsh::ompl::JointSpace> space = std::make_shared<pcl_bsh::ompl::JointSpace>(madeRobot());
};

TEST_F(JointSpace, HasADimensionForEachValue)
{
  ASSERT_EQ(space->getDimension(), 2u);
  EXPECT_EQ(space->getDimensionName(0), "wheel");
  EXPECT_EQ(space->getBounds().low, (std::vector<double>{-std::numbers::pi, -0.5}));
  EXPECT_EQ(space->getBounds().high, (std::vector<double>{std::numbers::pi, 1.5}));
}

TEST_F(JointSpace, GoesTheShorterWay)
{
  const State from = state(3.0, 0.0), to = state(-3.0, 1.0);
  const double way = 2 * std::numbers::pi - 6.0; // of the wheel
  EXPECT_NEAR(space->distance(from.get(), to.get()), std::hypot(way, 1.0), 1e-15);
  State between(space);
  space->interpolate(from.get(), to.get(), 0.25, between.get());
  EXPECT_NEAR(between[0], 3.0 + 0.25 * way, 1e-15);
  EXPECT_EQ(between[1], 0.25);
  space->interpolate(from.get(), to.get(), 0.75, between.get());
  EXPECT_NEAR(between[0], -3.0 - 0.25 * way, 1e-15);
}

TEST_F(JointSpace, TurnsBackIntoItsBounds)
{
  State outside = state(4.0, 2.0);
  outside.enforceBounds();
  EXPECT_NEAR(outside[0], 4.0 - 2 * std::numbers::pi, 1e-15);
  EXPECT_EQ(outside[1], 1.5);
}

TEST_F(JointSpace, RefusesJointsWithoutLimits)
{
  for (const auto& [lower, upper] : {std::pair(0.0, std::numeric_limits<double>::infinity()), std::pair(1.0, 1.0)}) {
    Robot robot = madeRobot();
    robot.links[2].joint->lower = lower, robot.links[2].joint->upper = upper;
    EXPECT_THAT(test::refusalOf([&] { pcl_bsh::ompl::JointSpace space(robot); }),
                StartsWith("joint 'lift': has no finite limits"));
  }
}

} // namespace
} // namespace pcl_bsh
