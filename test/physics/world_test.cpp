// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/physics/world.h>

#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

namespace pcl_bsh {
namespace {

using test::at;
using test::kGravity;
using test::kStep;
using test::TestMesh;

/// A surface, and its mass where it closes.
struct Shape {
  explicit Shape(TestMesh of) : mesh(std::move(of)), hierarchy(viewOf(mesh.trianglesView())), collider(hierarchy) {}

  MassProperties mass(double density) const { return massOf(Solid(mesh.trianglesView()), density); }

  TestMesh mesh;
  SphereHierarchy hierarchy;
  Collider collider;
};

Shape plane(double reach = 20.0)
{
  return Shape(test::planeMesh(reach));
}

Shape box(double x, double y, double z)
{
  return Shape(test::crateMesh(x, y, z));
}

struct Ball {
  explicit Ball(float of) : radius{of}, hierarchy(view()), collider(hierarchy) {}

  PointsView view() const
  {
    PointsView one = viewOf(place.data(), 1);
    one.radii = radius.data();
    return one;
  }
  MassProperties mass(double density) const { return massOf(view(), density); }

  std::vector<double> place = {0, 0, 0};
  std::vector<float> radius;
  SphereHierarchy hierarchy;
  Collider collider;
};

TEST(World, BodiesFallAsTheFormulaSays)
{
  const Ball ball(0.1f);
  World world;
  const BodyId body = world.add(ball.collider, at(5e6, 0, 100), ball.mass(1000));
  for (int i = 0; i < 240; ++i) world.step(kStep);
  EXPECT_NEAR(world.velocity(body).z(), -kGravity, 1e-4);
  // The solver moves by the velocity at the end of each step.
  EXPECT_NEAR(100 - world.pose(body).translation().z(), 0.5 * kGravity * (1.0 + kStep), 1e-3);
}

TEST(World, DampingTakesItsShareInASecond)
{
  const Ball ball(0.1f);
  WorldOptions options;
  options.gravity.setZero();
  options.damping = 0.75;
  World world(options);
  const BodyId body = world.add(ball.collider, at(0, 0, 0), ball.mass(1000));
  world.setVelocity(body, {8, 0, 0}, {0, 4, 0});
  for (int i = 0; i < 240; ++i) world.step(kStep);
  EXPECT_NEAR(world.velocity(body).x(), 2.0, 1e-3);
  EXPECT_NEAR(world.spin(body).y(), 1.0, 1e-3);
}

TEST(World, SpinningBodiesKeepTheirMomentum)
{
  const Shape top = box(1, 0.5, 0.25);
  WorldOptions options;
  options.gravity.setZero();
  World world(options);
  const MassProperties mass = top.mass(1000);
  const BodyId body = world.add(top.collider, at(0, 0, 0), mass);
  world.setVelocity(body, {0, 0, 0}, {0.1, 3, 0.2});
  const auto momentum = [&]() -> Eigen::Vector3d {
    const Eigen::Matrix3d turn = world.pose(body).linear();
    return turn * mass.inertia * turn.transpose() * world.spin(body);
  };
  const Eigen::Vector3d before = momentum();
  for (int i = 0; i < 480; ++i) world.step(kStep);
  EXPECT_LT((momentum() - before).norm(), 0.02 * before.norm());
}

TEST(World, BoxesSlideOnASlopeAsFrictionSays)
{
  const Shape slope = plane(200), crate = box(1, 1, 0.5);
  const double angle = 0.5, share = 0.3;
  const Eigen::Isometry3d tilt(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
  World world;
  world.addFixed(slope.collider, tilt, {1.0, 0.0});
  const BodyId body = world.add(crate.collider, tilt * at(0, 0, 0.251), crate.mass(500), {share, 0.0});
  for (int i = 0; i < 240; ++i) world.step(kStep);
  const double expected = kGravity * (std::sin(angle) - share * std::cos(angle));
  EXPECT_NEAR(world.velocity(body).norm(), expected, 0.02 * expected);
  EXPECT_NEAR((tilt.inverse() * world.pose(body)).translation().z(), 0.251, 1e-3);
}

TEST(World, BoxesHoldOnASlopeWhereFrictionIsEnough)
{
  const Shape slope = plane(), crate = box(1, 1, 0.5);
  const Eigen::Isometry3d tilt(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));
  World world;
  world.addFixed(slope.collider, tilt, {1.0, 0.0});
  const BodyId body = world.add(crate.collider, tilt * at(0, 0, 0.251), crate.mass(500), {0.6, 0.0});
  for (int i = 0; i < 720; ++i) world.step(kStep);
  EXPECT_LT((tilt.inverse() * world.pose(body).translation() - Eigen::Vector3d(0, 0, 0.251)).norm(), 1e-3);
  EXPECT_TRUE(world.isAsleep(body));
}

TEST(World, BallsBounceAsHighAsRestitutionSays)
{
  const Shape ground = plane();
  const Ball ball(0.1f);
  World world;
  world.addFixed(ground.collider, at(0, 0, 0), {1.0, 1.0});
  const BodyId body = world.add(ball.collider, at(0, 0, 1.101), ball.mass(1000), {0.5, 0.5});
  double highest = 0.0;
  bool has_met = false;
  for (int i = 0; i < 240; ++i) {
    world.step(kStep);
    has_met = has_met || world.velocity(body).z() > 0.0;
    if (has_met) highest = std::max(highest, world.pose(body).translation().z() - 0.101);
  }
  EXPECT_NEAR(highest, 0.25, 0.02);
}

/// A ball that swings about a place 1 m from its middle.
TEST(World, ASocketHoldsAPendulum)
{
  const Ball ball(0.1f), nail(0.01f);
  World world;
  const BodyId hook = world.addFixed(nail.collider, at(5e6, 0, 2));
  const double angle = 0.1, inertia = 1.0 + 0.4 * 0.01;
  const Eigen::Vector3d place = at(5e6, 0, 2).translation();
  const BodyId body = world.add(ball.collider, at(5e6 + std::sin(angle), 0, 2 - std::cos(angle)), ball.mass(1000));
  world.join(body, hook, {place});
  const Eigen::Vector3d held = world.pose(body).inverse() * place;
  int crossings = 0, last = 0;
  for (int i = 1; i <= 2400; ++i) {
    const double before = world.pose(body).translation().x() - 5e6;
    world.step(kStep);
    ASSERT_LT((world.pose(body) * held - place).norm(), 1e-4) << i;
    if (before * (world.pose(body).translation().x() - 5e6) < 0.0) ++crossings, last = i;
  }
  const double period = 2 * std::numbers::pi * std::sqrt(inertia / kGravity) * (1 + angle * angle / 16);
  EXPECT_NEAR(last * kStep, (0.5 * crossings - 0.25) * period, 0.01 * last * kStep);
  EXPECT_EQ(crossings, 10); // in 10 s
}

TEST(World, AHingeKeepsItsAxis)
{
  const Shape post = box(0.1, 0.1, 2), door = box(0.8, 0.05, 2);
  World world;
  const BodyId frame = world.addFixed(post.collider);
  const BodyId leaf = world.add(door.collider, at(0.45, 0, 0), door.mass(500), {});
  world.step(kStep);
  EXPECT_FALSE(world.contacts().empty());
  world.join(leaf, frame, {{0.5, 0, 1}});
  world.join(leaf, frame, {{0.05, 0, 0}, Eigen::Vector3d(0, 0, 3)});
  EXPECT_TRUE(world.contacts().empty());
  world.setVelocity(leaf, {0, 0.8, 0}, {0.5, 0, 2});
  double turned = 0.0;
  for (int i = 0; i < 480; ++i) {
    world.step(kStep);
    turned += kStep * world.spin(leaf).z();
    ASSERT_LT((world.pose(leaf) * Eigen::Vector3d(-0.4, 0, 0) - Eigen::Vector3d(0.05, 0, 0)).norm(), 1e-2) << i;
    ASSERT_GT(world.pose(leaf).linear()(2, 2), 0.999) << i;
  }
  EXPECT_GT(turned, 1.0);
  EXPECT_TRUE(world.contacts().empty()); // though it stands in its post as it turns
}

/// The first of two balls in a row is cut at a plate: the other one waits with it.
TEST(World, JoinedBodiesAreCutTogether)
{
  const Shape plate = plane();
  const Ball ball(0.1f);
  World world;
  world.addFixed(plate.collider);
  const BodyId lower = world.add(ball.collider, at(0, 0, 1), ball.mass(1000));
  const BodyId upper = world.add(ball.collider, at(0, 0, 1.15), ball.mass(1000));
  world.join(lower, upper, {{0, 0, 1.075}});
  for (const BodyId body : {lower, upper}) world.setVelocity(body, {0, 0, -1000});
  std::size_t cut = 0;
  for (int i = 0; i < 240; ++i) {
    cut += world.step(kStep).cut;
    const Eigen::Vector3d low = world.pose(lower) * Eigen::Vector3d(0, 0, 0.075),
                          high = world.pose(upper) * Eigen::Vector3d(0, 0, -0.075);
    ASSERT_LT((low - high).norm(), 1e-2) << i;
    ASSERT_GE(world.pose(lower).translation().z(), 0.1) << i;
  }
  EXPECT_GE(cut, 2u);
}

/// A crate at rest holds a ball that swings: it stays awake for as long.
TEST(World, JoinedBodiesSleepTogether)
{
  const Shape ground = plane(), crate = box(1, 1, 1);
  const Ball ball(0.1f);
  WorldOptions options;
  options.damping = 0.5;
  World world(options);
  world.addFixed(ground.collider);
  const BodyId holds = world.add(crate.collider, at(0, 0, 0.501), crate.mass(1000));
  const BodyId swings = world.add(ball.collider, at(1.1, 0, 0.8), ball.mass(10));
  world.join(holds, swings, {{0.7, 0, 0.8}});
  for (int i = 0; i < 4800; ++i) {
    world.step(kStep);
    ASSERT_EQ(world.isAsleep(holds), world.isAsleep(swings)) << i;
  }
  EXPECT_TRUE(world.isAsleep(swings));
  EXPECT_NEAR(world.pose(swings).translation().z(), 0.4, 1e-2);
}

TEST(World, BallsRollDownASlope)
{
  const Shape slope = plane(200);
  const Ball ball(0.5f);
  const double angle = 0.2;
  const Eigen::Isometry3d tilt(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
  World world;
  world.addFixed(slope.collider, tilt, {1.0, 0.0});
  const BodyId body = world.add(ball.collider, tilt * at(0, 0, 0.501), ball.mass(1000), {1.0, 0.0});
  for (int i = 0; i < 240; ++i) world.step(kStep);
  const double expected = kGravity * std::sin(angle) / 1.4;
  EXPECT_NEAR(world.velocity(body).norm(), expected, 0.02 * expected);
}

/// With sleeping off, so that nothing but contacts holds it.
TEST(World, ABoxAtRestDoesNotDrift)
{
  const Shape ground = plane(), crate = box(1, 1, 1);
  WorldOptions options;
  options.sleeping = false;
  World world(options);
  world.addFixed(ground.collider);
  const BodyId body = world.add(crate.collider, at(0.3, -0.2, 0.501), crate.mass(500));
  for (int i = 0; i < 10000; ++i) world.step(kStep);
  EXPECT_LT((world.pose(body).translation() - Eigen::Vector3d(0.3, -0.2, 0.501)).norm(), 1e-4);
}

/// Ten boxes, each a little smaller than the one below, so that its corners are on a face.
std::vector<BodyId> addStack(World& world, std::vector<std::unique_ptr<Shape>>& shapes)
{
  std::vector<BodyId> boxes;
  for (int i = 0; i < 10; ++i) {
    const double size = 1.0 - 0.02 * i;
    shapes.push_back(std::make_unique<Shape>(test::crateMesh(size, size, 1)));
    boxes.push_back(world.add(shapes.back()->collider, at(0, 0, 0.501 + 1.001 * i), shapes.back()->mass(100)));
  }
  return boxes;
}

TEST(World, AStackOfBoxesStandsAndSleeps)
{
  const Shape ground = plane();
  std::vector<std::unique_ptr<Shape>> shapes;
  World world;
  world.addFixed(ground.collider);
  const std::vector<BodyId> boxes = addStack(world, shapes);
  for (int i = 0; i < 1200; ++i) world.step(kStep);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double height = 0.501 + 1.001 * static_cast<double>(i);
    EXPECT_LT((world.pose(boxes[i]).translation() - Eigen::Vector3d(0, 0, height)).norm(), 1e-3) << i;
    EXPECT_TRUE(world.isAsleep(boxes[i])) << i;
  }
}

TEST(World, AStackOfBoxesDoesNotDrift)
{
  const Shape ground = plane();
  std::vector<std::unique_ptr<Shape>> shapes;
  WorldOptions options;
  options.sleeping = false;
  World world(options);
  world.addFixed(ground.collider);
  const std::vector<BodyId> boxes = addStack(world, shapes);
  for (int i = 0; i < 1000; ++i) world.step(kStep);
  std::vector<Eigen::Isometry3d> before;
  for (const BodyId box : boxes) before.push_back(world.pose(box));
  for (int i = 0; i < 3000; ++i) world.step(kStep);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    EXPECT_LT((world.pose(boxes[i]).translation() - before[i].translation()).norm(), 1e-4) << i;
}

TEST(World, NothingPassesAPlateHoweverFast)
{
  const Shape plate = box(4, 4, 0.01);
  const Ball dot(0.002f);
  for (const double speed : {1.0, 240.0, 24000.0}) { // up to 100 m in a step
    World world;
    world.addFixed(plate.collider);
    const BodyId body = world.add(dot.collider, at(0.3, 0.1, 1), dot.mass(1000));
    world.setVelocity(body, {0, 0, -speed});
    std::size_t cut = 0;
    for (int i = 0; i < 240; ++i) {
      cut += world.step(kStep).cut;
      ASSERT_GT(world.pose(body).translation().z(), 0.005 + 0.002) << speed;
    }
    if (speed > 100.0) {
      EXPECT_GT(cut, 0u);
    }
  }
}

TEST(World, ARodThatTurnsIntoAWallStopsThere)
{
  const Shape rod = box(2, 0.05, 0.05), wall = box(0.02, 4, 4);
  WorldOptions options;
  options.gravity.setZero();
  World world(options);
  world.addFixed(wall.collider, at(0.8, 0, 0));
  const BodyId body =
      world.add(rod.collider, Eigen::Isometry3d(Eigen::AngleAxisd(1.3, Eigen::Vector3d::UnitZ())), rod.mass(1000));
  world.setVelocity(body, {0, 0, 0}, {0, 0, -500});
  for (int i = 0; i < 50; ++i) {
    world.step(kStep);
    for (const double x : {-1.0, 1.0}) {
      const Eigen::Vector3d end = world.pose(body) * Eigen::Vector3d(x, 0, 0);
      const Eigen::Vector3d middle = world.pose(body).translation();
      ASSERT_LT(std::max(end.x(), middle.x()), 0.79) << i;
    }
  }
}

TEST(World, WhatIsMovedPushesBodiesAndWakesThem)
{
  const Shape ground = plane(), crate = box(1, 1, 1), hand = box(0.2, 0.6, 0.6);
  World world;
  world.addFixed(ground.collider);
  const BodyId pusher = world.addFixed(hand.collider, at(-0.8, 0, 0.5));
  const BodyId body = world.add(crate.collider, at(0, 0, 0.501), crate.mass(100), {0.3, 0.0});
  for (int i = 0; i < 700; ++i) world.step(kStep);
  ASSERT_TRUE(world.isAsleep(body));
  for (int i = 0; i < 240; ++i) {
    world.moveTo(pusher, at(-0.8 + 0.5 * (i + 1) * kStep, 0, 0.5));
    world.step(kStep);
  }
  EXPECT_NEAR(world.pose(body).translation().x(), 0.3, 0.02); // the hand comes to -0.3, and reaches 0.6 farther
}

/// Points on points, where both are scanned.
struct StoneOnTerrain {
  StoneOnTerrain()
  {
    mass.mass = 100;
    mass.inertia = Eigen::Vector3d(4.4, 4.4, 6.4).asDiagonal();
  }

  test::Random random{5};
  const std::vector<float> ground = test::terrainPoints(random), stone = test::stonePoints(random);
  const SphereHierarchy terrain{viewOf(ground.data(), ground.size() / 3)}, hull{viewOf(stone.data(), stone.size() / 3)};
  const Collider terrain_collider{terrain}, stone_collider{hull};
  MassProperties mass;
};

/// It neither sinks nor flies.
TEST(World, AStoneRestsOnScannedTerrain)
{
  const StoneOnTerrain things;
  World world;
  world.addFixed(things.terrain_collider);
  const BodyId body = world.add(things.stone_collider, at(0.2, 0.1, 0.6), things.mass);
  for (int i = 0; i < 2400; ++i) world.step(kStep);
  EXPECT_LT(world.velocity(body).norm(), 0.02);
  const Eigen::Vector3d there = world.pose(body).translation();
  EXPECT_GT(there.z(), -0.1 + 0.2);
  EXPECT_LT(there.z(), 0.1 + 0.5);
}

/// Nothing damps it, and nothing lets it sleep.
TEST(World, AStoneAtRestDoesNotDrift)
{
  constexpr double size = 0.8;
  const StoneOnTerrain things;
  WorldOptions options;
  options.sleeping = false;
  World world(options);
  world.addFixed(things.terrain_collider);
  const BodyId body = world.add(things.stone_collider, at(0.5, 0.3, 0.6), things.mass);
  for (int i = 0; i < 2400; ++i) world.step(kStep);
  const Eigen::Isometry3d before = world.pose(body);
  for (int i = 0; i < 10000; ++i) world.step(kStep);
  EXPECT_LT((world.pose(body).translation() - before.translation()).norm(), 1e-6 * size);
  const Eigen::AngleAxisd turned((before.linear().transpose() * world.pose(body).linear()).eval());
  EXPECT_LT(turned.angle(), 2e-6);
}

TEST(World, RefusesWhatHasNoMeaning)
{
  const Ball ball(1.0f);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  WorldOptions gravity, margin, thickness, contacts, damping;
  gravity.gravity.x() = nan, margin.margin = 0, thickness.thickness = -1, contacts.contacts = 0;
  damping.damping = 1.5;
  for (const WorldOptions& options : {gravity, margin, thickness, contacts, damping})
    EXPECT_THROW(World{options}, InvalidInput);
  World world;
  MassProperties weightless = ball.mass(1);
  weightless.mass = 0;
  EXPECT_THROW(world.add(ball.collider, at(0, 0, 0), weightless), InvalidInput);
  MassProperties flat = ball.mass(1);
  flat.inertia(0, 0) = nan;
  EXPECT_THROW(world.add(ball.collider, at(0, 0, 0), flat), InvalidInput);
  EXPECT_THROW(world.addFixed(ball.collider, at(0, 0, 0), {-1, 0}), InvalidInput);
  EXPECT_THROW(world.addFixed(ball.collider, at(0, 0, 0), {1, 2}), InvalidInput);
  EXPECT_THROW(world.addFixed(ball.collider, at(nan, 0, 0)), InvalidInput);
  EXPECT_THROW(world.step(0), InvalidInput);
  EXPECT_EQ(world.size(), 0u);

  const BodyId floor = world.addFixed(ball.collider), wall = world.addFixed(ball.collider, at(0, 9, 0)),
               body = world.add(ball.collider, at(9, 0, 0), ball.mass(1));
  EXPECT_THROW(world.join(floor, wall, {{0, 0, 0}}), InvalidInput);
  EXPECT_THROW(world.join(body, body, {{0, 0, 0}}), InvalidInput);
  EXPECT_THROW(world.join(body, floor, {{nan, 0, 0}}), InvalidInput);
  EXPECT_THROW(world.join(body, floor, {{0, 0, 0}, Eigen::Vector3d(0, 0, 0)}), InvalidInput);
  EXPECT_THROW(world.join(body, floor, {{0, 0, 0}, Eigen::Vector3d(0, 0, nan)}), InvalidInput);
}

} // namespace
} // namespace pcl_bsh
