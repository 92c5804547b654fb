// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/scene_warnings.h>

#include "solid/meshes.h"

#include <gmock/gmock.h>

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A tank of 8 m about the origin, and a robot of 1 m in its middle.
class HollowScenes : public testing::Test {
protected:
  HollowScenes()
  {
    tank.add(test::boxMesh(), 8.0, {-4, -4, -4});
    robot.add(test::boxMesh(), 1.0, {-0.5, -0.5, -0.5});
    objects.resize(2);
    objects[0].name = "tank";
    objects[0].fixed = true;
    objects[0].parts.push_back({"tank.stl"});
    objects[1].name = "robot";
    objects[1].parts.push_back({"robot.stl"});
  }

  std::vector<std::string> told(std::optional<double> duration = std::nullopt, double clearance = 0.1)
  {
    std::map<std::string, Shape> clouds;
    clouds.emplace("tank.stl", Shape("tank.stl", viewOf(tank.view())));
    clouds.emplace("robot.stl", Shape("robot.stl", viewOf(robot.view())));
    for (auto& [name, shape] : clouds) shape.hierarchy({}, 1);
    return warningsOf(objects, clouds, clearance, duration);
  }

  test::ClosedMesh tank, robot;
  std::vector<NamedObject> objects;
};

TEST_F(HollowScenes, ToldOfARobotInATankThatIsNoSolid)
{
  EXPECT_THAT(told(),
              ElementsAre(AllOf(HasSubstr("'tank': its faces close round places of 'robot'"), HasSubstr("`solid`"))));
  objects[0].parts[0].solid = true;
  EXPECT_THAT(told(), IsEmpty());
}

TEST_F(HollowScenes, NotOfOneThatIsOpenOrHollow)
{
  tank.add(test::boxMesh(), 7.0, {-3.5, -3.5, -3.5}, true);
  EXPECT_THAT(told(), IsEmpty()) << "the robot is in the hollow";
  tank = test::ClosedMesh();
  tank.add(test::boxMesh(), 8.0, {-4, -4, -4});
  tank.corners.resize(tank.corners.size() - 3);
  EXPECT_THAT(told(), IsEmpty());
}

TEST_F(HollowScenes, NotWhereASurfaceIsNearOrBothAreFixed)
{
  objects[1].pose.translation().x() = 3.45;
  EXPECT_THAT(told(), IsEmpty()) << "which collides or nearly does";
  objects[1].pose.translation().x() = 3.2;
  EXPECT_EQ(told().size(), 1u);
  EXPECT_THAT(told(std::nullopt, 0.4), IsEmpty());
  objects[1].fixed = true;
  EXPECT_THAT(told(), IsEmpty());
}

TEST_F(HollowScenes, WhatMovesIsLookedAtOnItsWay)
{
  objects[1].pose.translation().x() = -20;
  objects[1].motion = VelocityMotion{{150, 0, 0}};
  EXPECT_THAT(told(), IsEmpty());
  EXPECT_THAT(told(0.1), IsEmpty());
  EXPECT_EQ(told(1.0).size(), 1u);
  objects[1].motion = VelocityMotion{{-150, 0, 0}};
  EXPECT_THAT(told(1.0), IsEmpty());
}

TEST_F(HollowScenes, PartsAreLookedAtWhereTheyStand)
{
  objects[0].pose.translation().y() = 50;
  objects[1].pose.translation().y() = 45;
  EXPECT_THAT(told(), IsEmpty());
  objects[1].parts[0].pose.translation().y() = 5;
  EXPECT_EQ(told().size(), 1u);
  objects[0].parts[0].pose.translation().y() = -10;
  EXPECT_THAT(told(), IsEmpty());
}

} // namespace
} // namespace pcl_bsh
