// SPDX-License-Identifier: BSD-3-Clause
// An object that a hand leads: where it comes to, and what it is told to touch.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/scene/dragged_object.h>

#include "scene_worlds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using test::at;
using test::Random;
using test::sheet;
using test::Shelf;

constexpr double clearance = 0.05, tolerance = 1e-3;

SceneOptions responding(Response response)
{
  SceneOptions options;
  options.effects.response = response;
  options.clearance = clearance;
  options.tolerance = tolerance;
  return options;
}

/// A plate of points 0.1 apart, and a wall of 4 by 4 in the plane x = 0.
struct WallAndPlate {
  /// @param spacing of the wall
  explicit WallAndPlate(Response response, double spacing = 0.1) : scene(responding(response))
  {
    const int count = static_cast<int>(std::lround(4 / spacing)) + 1;
    scene.add(fixedObject("wall", shelf.add(sheet({0, -2, -2}, {0, spacing, 0}, {0, 0, spacing}, count, count))));
    plate = scene.add(object("plate", shelf.add(sheet({0, -0.2, -0.2}, {0, 0.1, 0}, {0, 0, 0.1}, 5, 5)), at(1, 0, 0)));
  }

  double distance() const
  {
    return brute_force::closestPair({*scene[0].parts[0].hierarchy},
                                    {*scene[plate].parts[0].hierarchy, scene[plate].pose})
        .distance;
  }

  Shelf shelf;
  Scene scene;
  ObjectId plate;
};

TEST(DraggedObject, WithoutAResponseGoesWhereItIsWanted)
{
  WallAndPlate world(Response::none);
  DraggedObject plate(world.scene, world.plate);
  const DragStep& there = plate.moveTo(at(-0.5, 0.03, 0));
  EXPECT_FALSE(there.held);
  EXPECT_EQ(there.pose.matrix(), at(-0.5, 0.03, 0).matrix());
  EXPECT_EQ(world.scene[world.plate].pose.matrix(), there.pose.matrix());
  ASSERT_TRUE(there.nearest);
  EXPECT_EQ(there.nearest->object, 0u);
  EXPECT_EQ(there.nearest->distance, world.distance());
  EXPECT_NEAR((there.nearest->place - there.nearest->other).norm(), there.nearest->distance, 1e-12);
  EXPECT_EQ(there.nearest->place.x(), -0.5);
  EXPECT_TRUE(there.contacts.empty());
}

TEST(DraggedObject, StopsBeforeTheWallAndTellsItsContacts)
{
  WallAndPlate world(Response::stop);
  DraggedObject plate(world.scene, world.plate);
  EXPECT_FALSE(plate.moveTo(at(0.4, 0, 0)).held);
  EXPECT_TRUE(plate.moveTo(at(0.4, 0, 0)).contacts.empty());
  const DragStep& met = plate.moveTo(at(-1, 0, 0.2));
  EXPECT_TRUE(met.held);
  EXPECT_GT(met.nearest->distance, clearance);
  EXPECT_LE(met.nearest->distance, clearance + tolerance);
  EXPECT_EQ(met.nearest->distance, world.distance());
  ASSERT_GE(met.contacts.size(), 4u);
  for (const Contact& contact : met.contacts) {
    EXPECT_NEAR(contact.normal.x(), 1.0, 1e-9) << "from the wall to the plate";
    EXPECT_EQ(contact.place_b.x(), 0.0);
    EXPECT_GE(contact.distance, met.nearest->distance - clearance - 1e-12);
  }
  EXPECT_NEAR(met.contacts.front().distance, met.nearest->distance - clearance, 1e-12);
  EXPECT_FALSE(plate.moveTo(at(0.5, 0, 0.2)).held) << "and it can be led away";
}

TEST(DraggedObject, SlidesAlongTheWall)
{
  WallAndPlate world(Response::slide, 0.01); // between points far apart, a plate of points is held
  DraggedObject plate(world.scene, world.plate);
  const DragStep& met = plate.moveTo(at(-0.5, 1.0, 0));
  EXPECT_TRUE(met.held);
  EXPECT_GT(met.pose.translation().x(), 0.0);
  EXPECT_GT(met.pose.translation().y(), 0.9) << "where it meets the wall, it is at 0.633";
  EXPECT_GT(met.nearest->distance, clearance);
  EXPECT_FALSE(met.contacts.empty());
}

TEST(DraggedObject, TellsOfNothingThatRulesLeaveOut)
{
  WallAndPlate world(Response::stop);
  DraggedObject plate(world.scene, world.plate);
  PairRule rule;
  rule.tested = false;
  world.scene.setRule(0, world.plate, rule);
  const DragStep& there = plate.moveTo(at(0, 0, 0));
  EXPECT_FALSE(there.held);
  EXPECT_FALSE(there.nearest);
  EXPECT_TRUE(there.contacts.empty());
}

/// Whatever was nearest before.
TEST(DraggedObject, FindsTheNearestOfMany)
{
  Random random(3);
  Shelf shelf;
  Scene scene(responding(Response::none));
  const ObjectId led = scene.add(object("led", shelf.add({{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}})));
  for (int i = 0; i < 20; ++i)
    scene.add(fixedObject("post " + std::to_string(i),
                          shelf.add({{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)},
                                     {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)}})));
  DraggedObject dragged(scene, led);
  for (int i = 0; i < 100; ++i) {
    Eigen::Isometry3d pose = at(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5));
    pose.rotate(Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d::UnitZ()));
    const DragStep& now = dragged.moveTo(pose);
    double least = std::numeric_limits<double>::infinity();
    ObjectId nearest = 0;
    for (ObjectId other = 1; other < scene.size(); ++other) {
      const double distance = brute_force::closestPair({*scene[led].parts[0].hierarchy, scene.worldPose(led)},
                                                       {*scene[other].parts[0].hierarchy, scene.worldPose(other)})
                                  .distance;
      if (distance < least) least = distance, nearest = other;
    }
    ASSERT_TRUE(now.nearest);
    EXPECT_EQ(now.nearest->distance, least);
    EXPECT_EQ(now.nearest->object, nearest);
  }
}

TEST(DraggedObject, TheMarginSaysWhichContactsAreTold)
{
  WallAndPlate world(Response::stop);
  DragOptions wide;
  wide.margin = 0.5;
  DraggedObject plate(world.scene, world.plate, wide);
  EXPECT_FALSE(plate.moveTo(at(0.5, 0, 0)).contacts.empty());
  wide.margin = 0.4;
  EXPECT_TRUE(DraggedObject(world.scene, world.plate, wide).look().contacts.empty());
}

TEST(DraggedObject, WhatHasNoMeaningMovesNothing)
{
  WallAndPlate world(Response::stop);
  DragOptions options;
  options.margin = -1.0;
  EXPECT_THROW(DraggedObject(world.scene, world.plate, options), InvalidInput);
  EXPECT_THROW(DraggedObject(world.scene, 2), std::out_of_range);
  DraggedObject plate(world.scene, world.plate);
  Eigen::Isometry3d scaled = at(0.5, 0, 0);
  scaled.linear() *= 2.0;
  EXPECT_THROW(plate.moveTo(scaled), std::invalid_argument);
  EXPECT_THROW(plate.moveTo(at(1e12, 0, 0)), std::invalid_argument) << "a way that cannot be followed exactly";
  EXPECT_EQ(world.scene[world.plate].pose.matrix(), at(1, 0, 0).matrix());
  EXPECT_FALSE(plate.moveTo(at(0.5, 0, 0)).held);
  EXPECT_EQ(world.scene[world.plate].pose.matrix(), at(0.5, 0, 0).matrix());
}

} // namespace
} // namespace pcl_bsh
