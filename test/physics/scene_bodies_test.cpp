// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/physics/scene_bodies.h>

#include "shapes.h"
#include "support/refusal.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::at;
using test::kGravity;
using test::kStep;
using test::refusalOf;
using test::TestMesh;
using testing::HasSubstr;

struct Mesh {
  explicit Mesh(TestMesh of)
  : mesh(std::make_unique<TestMesh>(std::move(of))),
    hierarchy(std::make_shared<SphereHierarchy>(viewOf(mesh->trianglesView())))
  {
  }

  std::unique_ptr<TestMesh> mesh;
  std::shared_ptr<SphereHierarchy> hierarchy;
};

struct Cloud {
  explicit Cloud(std::vector<float> of)
  : xyz(std::make_unique<std::vector<float>>(std::move(of))),
    hierarchy(std::make_shared<SphereHierarchy>(viewOf(xyz->data(), xyz->size() / 3)))
  {
  }

  std::unique_ptr<std::vector<float>> xyz;
  std::shared_ptr<SphereHierarchy> hierarchy;
};

struct RoundBody {
  explicit RoundBody(float of) : radius(std::make_unique<float>(of)), place(std::make_unique<Point3>())
  {
    *place = {0, 0, 0};
    PointsView one = viewOf(place->data(), 1);
    one.radii = radius.get();
    hierarchy = std::make_shared<SphereHierarchy>(one);
  }

  std::unique_ptr<float> radius;
  std::unique_ptr<Point3> place;
  std::shared_ptr<SphereHierarchy> hierarchy;
};

SceneBody heavy(double density, Material material = {})
{
  SceneBody body;
  body.density = density;
  body.material = material;
  return body;
}

SceneBody ofMass(double mass, Material material = {})
{
  SceneBody body;
  body.mass = mass;
  body.material = material;
  return body;
}

SceneBody ground(Material material = {})
{
  SceneBody body;
  body.material = material;
  return body;
}

TEST(SceneBodies, FallAsTheFormulaSays)
{
  const Mesh crate(test::crateMesh(1, 1, 1));
  Scene scene{SceneOptions{}};
  scene.add(object("crate", crate.hierarchy, at(5e6, 0, 100)));
  const auto bodies = makeSceneBodies(scene, {}, {heavy(1000)});
  EXPECT_TRUE(bodies->warnings().empty());
  for (int i = 0; i < 10; ++i) EXPECT_EQ(bodies->step(0.1).steps, 24u);
  EXPECT_NEAR(scene.time(), 1.0, 1e-12);
  const BodyState state = bodies->states().at(0);
  EXPECT_NEAR(state.velocity.z(), -kGravity, 1e-4);
  // The solver moves by the velocity at the end of each step.
  EXPECT_NEAR(100 - scene[0].pose.translation().z(), 0.5 * kGravity * (1.0 + kStep), 1e-3);
  EXPECT_EQ(scene[0].pose.matrix(), state.pose.matrix());
  EXPECT_TRUE(bodies->contacts().empty());
}

/// Gravity goes where it is told to, as strong as it is told.
TEST(SceneBodies, FallAlongGravity)
{
  const Mesh crate(test::crateMesh(1, 1, 1));
  Scene scene{SceneOptions{}};
  scene.add(object("crate", crate.hierarchy));
  BodiesOptions options;
  options.gravity = {1.6, 0, 0};
  options.step = 0.01;
  const auto bodies = makeSceneBodies(scene, options, {ofMass(7)});
  EXPECT_EQ(bodies->step(0.5).steps, 50u);
  EXPECT_NEAR(scene[0].pose.translation().x(), 0.5 * 1.6 * 0.5 * 0.51, 1e-4);
}

/// By the friction of both against the slope: it stays, or gains speed.
TEST(SceneBodies, HoldOrSlideOnASlopeAsFrictionSays)
{
  const Mesh slope(test::planeMesh(200)), crate(test::crateMesh(1, 1, 0.5));
  const double angle = 0.4; // its tangent is 0.42
  const Eigen::Isometry3d tilt(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
  for (const double friction : {0.2, 0.35, 0.5, 0.8}) {
    Scene scene{SceneOptions{}};
    scene.add(fixedObject("slope", slope.hierarchy, tilt));
    scene.add(object("crate", crate.hierarchy, tilt * at(0, 0, 0.251)));
    const auto bodies = makeSceneBodies(scene, {}, {ground({0.5, 0}), heavy(800, {2 * friction, 0})});
    for (int i = 0; i < 10; ++i) bodies->step(0.1);
    const double gain = kGravity * (std::sin(angle) - friction * std::cos(angle));
    const Eigen::Vector3d there = tilt.inverse() * scene[1].pose.translation();
    EXPECT_NEAR(there.z(), 0.251, 1e-3) << friction;
    if (friction > std::tan(angle)) {
      EXPECT_LT(there.head<2>().norm(), 1e-3) << friction;
    }
    else {
      EXPECT_NEAR(there.x(), 0.5 * gain, 0.03 * 0.5 * gain + 0.01) << friction;
      EXPECT_NEAR(bodies->states()[0].velocity.norm(), gain, 0.03 * gain) << friction;
    }
  }
}

/// The speed along a slope after a second, of what rolls there by itself, over that of what slides without friction.
double shareOfSliding(const std::shared_ptr<SphereHierarchy>& wheel, double radius, const SceneBody& how)
{
  const Mesh slope(test::planeMesh(200));
  const double angle = 0.2;
  const Eigen::Isometry3d tilt(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
  Scene scene{SceneOptions{}};
  scene.add(fixedObject("slope", slope.hierarchy, tilt));
  scene.add(object("wheel", wheel, tilt * at(0, 0, radius + 0.001)));
  const auto bodies = makeSceneBodies(scene, {}, {ground({1, 0}), how});
  bodies->step(1.0);
  return bodies->states()[0].velocity.norm() / (kGravity * std::sin(angle));
}

/// A ball has 2/5 of its mass times the square of its radius, a hoop of points all of it.
TEST(SceneBodies, RollAsTheirInertiaSays)
{
  const RoundBody ball(0.5f);
  EXPECT_NEAR(shareOfSliding(ball.hierarchy, 0.5, heavy(1000, {1, 0})), 1 / 1.4, 0.01);
  EXPECT_NEAR(shareOfSliding(ball.hierarchy, 0.5, ofMass(3, {1, 0})), 1 / 1.4, 0.01);
  SceneBody shell = ofMass(3, {1, 0});
  shell.inertia = Eigen::Vector3d(0.5, 0.5, 0.5); // 2/3 of that
  EXPECT_NEAR(shareOfSliding(ball.hierarchy, 0.5, shell), 3.0 / 5, 0.01);
  std::vector<float> xyz;
  for (int i = 0; i < 3 * 720; ++i) {
    const double angle = 2 * std::numbers::pi * (i % 720) / 720;
    xyz.insert(xyz.end(), {float(0.5 * std::sin(angle)), float(0.2 * (i / 720 - 1)), float(-0.5 * std::cos(angle))});
  }
  const Cloud hoop(std::move(xyz));
  EXPECT_NEAR(shareOfSliding(hoop.hierarchy, 0.5, ofMass(3, {1, 0})), 1.0 / 2, 0.02);
}

struct Fall {
  std::vector<Eigen::Matrix4d> poses;
  std::vector<double> distances;
  BodyState last;
  std::vector<BodyContacts> contacts;
  WorldStep solved;
};

/// A stone on terrain, both scanned.
Fall fallOfStone(unsigned threads)
{
  test::Random random(5);
  const Cloud terrain(test::terrainPoints(random)), stone(test::stonePoints(random));
  SceneOptions options;
  options.threads = threads;
  options.clearance = 0.001;
  options.effects.any = true;
  options.effects.distance = std::numeric_limits<double>::infinity();
  Scene scene(options);
  scene.add(fixedObject("terrain", terrain.hierarchy));
  scene.add(object("stone", stone.hierarchy, at(0.2, 0.1, 0.6)));
  SceneBody how = ofMass(100);
  how.inertia = Eigen::Vector3d(4.4, 4.4, 6.4);
  BodiesOptions of_bodies;
  of_bodies.damping = 0.5;
  const auto bodies = makeSceneBodies(scene, of_bodies, {ground(), how});
  Fall fall;
  for (int i = 0; i < 80; ++i) {
    const BodiesStep step = bodies->step(0.1);
    fall.solved.pairs += step.solved.pairs;
    fall.solved.contacts += step.solved.contacts;
    fall.solved.work += step.solved.work;
    fall.poses.push_back(scene[1].pose.matrix());
    fall.distances.push_back(step.scene.distance.at(0).distance);
    EXPECT_EQ(fall.distances.back(), closestPair({*terrain.hierarchy}, {*stone.hierarchy, scene[1].pose}).distance);
    EXPECT_TRUE(step.scene.any.empty()) << "it lies on the terrain, not in it";
  }
  fall.last = bodies->states().at(0);
  fall.contacts = bodies->contacts();
  return fall;
}

TEST(SceneBodies, AStoneRestsOnTerrainWithTheSameBitsForAnyThreads)
{
  const Fall one = fallOfStone(1), two = fallOfStone(2);
  EXPECT_TRUE(one.last.asleep);
  EXPECT_EQ(one.last.velocity, Eigen::Vector3d(0, 0, 0));
  EXPECT_GT(one.last.pose.translation().z(), 0.1);
  EXPECT_LT(one.last.pose.translation().z(), 0.6);
  EXPECT_EQ(one.poses[78], one.poses[79]);
  ASSERT_EQ(one.contacts.size(), 1u);
  EXPECT_EQ(one.contacts[0].a, 0u);
  EXPECT_EQ(one.contacts[0].b, 1u);
  EXPECT_GE(one.contacts[0].contacts.size(), 3u);
  EXPECT_GT(one.solved.contacts, 0u);
  EXPECT_EQ(one.poses, two.poses);
  EXPECT_EQ(one.distances, two.distances);
  EXPECT_EQ(one.solved.pairs, two.solved.pairs);
  EXPECT_EQ(one.solved.work.node_pairs, two.solved.work.node_pairs);
}

/// It does not give way: the crate moves as far as it pushes.
TEST(SceneBodies, WhatHasAMotionPushes)
{
  const Mesh floor(test::planeMesh()), crate(test::crateMesh(1, 1, 1)), hand(test::crateMesh(0.2, 0.6, 0.6));
  Scene scene{SceneOptions{}};
  scene.add(fixedObject("floor", floor.hierarchy));
  SceneObject pusher = object("hand", hand.hierarchy, at(-0.8, 0, 0.5));
  pusher.motion = VelocityMotion{{0.5, 0, 0}, {0, 0, 0}};
  scene.add(std::move(pusher));
  scene.add(object("crate", crate.hierarchy, at(0, 0, 0.501)));
  const auto bodies = makeSceneBodies(scene, {}, {ground(), ground(), ofMass(100, {0.3, 0})});
  for (int i = 0; i < 10; ++i) bodies->step(0.1);
  EXPECT_NEAR(scene[1].pose.translation().x(), -0.3, 1e-9);
  EXPECT_NEAR(scene[2].pose.translation().x(), 0.3, 0.02); // the hand reaches 0.1, the crate 0.5 farther
  EXPECT_EQ(bodies->states().size(), 1u);
}

/// A crate and a second one before a wall, on a floor; a hand without a mass above.
struct CratesAtAWall {
  CratesAtAWall()
  {
    scene.add(fixedObject("floor", floor.hierarchy));
    scene.add(fixedObject("wall", wall.hierarchy, at(3, 0, 1)));
    scene.add(object("crate", crate.hierarchy, at(0, 0, 0.501)));
    scene.add(object("second", crate.hierarchy, at(1.3, 0, 0.501)));
    scene.add(object("hand", hand.hierarchy, at(-1, 0, 3)));
    bodies = makeSceneBodies(scene, {}, {ground(), ground(), ofMass(100, {0.3, 0}), ofMass(50, {0.3, 0}), ground()});
  }

  double x(ObjectId object) const { return scene[object].pose.translation().x(); }

  Mesh floor = Mesh(test::planeMesh()), wall = Mesh(test::crateMesh(0.2, 4, 2)), crate = Mesh(test::crateMesh(1, 1, 1)),
       hand = Mesh(test::crateMesh(0.2, 0.6, 0.6));
  Scene scene{SceneOptions{}};
  std::unique_ptr<SceneBodies> bodies;
};

TEST(SceneBodies, ABodyThatIsLedPushesAnotherAndStopsAtAWall)
{
  CratesAtAWall world;
  for (int i = 0; i < 180; ++i) { // the wall's face is at 2.9
    world.bodies->lead(2, at(0.02 * i, 0, 0.6));
    world.bodies->step(1.0 / 60);
    ASSERT_LT(world.x(2) + 0.5, world.x(3) - 0.5) << i;
    ASSERT_LT(world.x(3) + 0.5, 2.9) << i;
  }
  EXPECT_NEAR(world.x(3), 2.4, 0.02);
  EXPECT_NEAR(world.x(2), 1.4, 0.04);
  EXPECT_GT(world.scene[2].pose.translation().z(), 0.52) << "it is held in the air";
  world.bodies->release(2);
  for (int i = 0; i < 120; ++i) world.bodies->step(1.0 / 60);
  EXPECT_NEAR(world.scene[2].pose.translation().z(), 0.501, 2e-3) << "it falls";
}

/// However far away the hand is: no faster than 4 m in a second.
TEST(SceneBodies, WhatIsLedWithoutAMassPushesAndStaysWhereItIsReleased)
{
  CratesAtAWall world;
  world.bodies->lead(4, at(-1, 0, 0.5));
  for (int i = 0; i < 30; ++i) world.bodies->step(1.0 / 60);
  EXPECT_NEAR(world.scene[4].pose.translation().z(), 1.0, 1e-9);
  for (int i = 0; i < 10; ++i) world.bodies->step(1.0 / 60);
  EXPECT_EQ(world.scene[4].pose.matrix(), at(-1, 0, 0.5).matrix());
  world.bodies->lead(4, at(-0.2, 0, 0.5));
  for (int i = 0; i < 60; ++i) world.bodies->step(1.0 / 60);
  EXPECT_EQ(world.x(4), -0.2);
  EXPECT_GT(world.x(2), 0.4) << "the crate gave way";
  world.bodies->release(4);
  world.bodies->step(0.5);
  EXPECT_EQ(world.x(4), -0.2);
}

TEST(SceneBodies, WhatStoodStillCanBeLed)
{
  CratesAtAWall world;
  world.bodies->lead(1, at(2.5, 0, 1));
  for (int i = 0; i < 60; ++i) world.bodies->step(1.0 / 60);
  EXPECT_EQ(world.x(1), 2.5);
  EXPECT_EQ(world.bodies->states().size(), 2u);
  Eigen::Isometry3d scaled = at(0, 0, 0);
  scaled.linear() *= 2.0;
  EXPECT_THROW(world.bodies->lead(1, scaled), InvalidInput);
}

/// Where waypoints begin elsewhere, it is there at once, and sweeps nothing on the way.
TEST(SceneBodies, WaypointsBeginWhereTheySay)
{
  const Mesh crate(test::crateMesh(1, 1, 1)), hand(test::crateMesh(0.2, 0.6, 0.6));
  Scene scene{SceneOptions{}};
  SceneObject pusher = object("hand", hand.hierarchy, at(-5, 0, 0));
  pusher.motion = WaypointMotion{{0.5, 1}, {at(5, 0, 0), at(6, 0, 0)}};
  scene.add(std::move(pusher));
  scene.add(object("crate", crate.hierarchy));
  const auto bodies = makeSceneBodies(scene, {}, {ground(), ofMass(1)});
  EXPECT_EQ(scene[0].pose.matrix(), at(5, 0, 0).matrix());
  bodies->step(0.75);
  EXPECT_LT((scene[0].pose.matrix() - at(5.5, 0, 0).matrix()).norm(), 1e-12);
  EXPECT_EQ(scene[1].pose.translation().x(), 0.0);
}

/// A crate that cannot go on stops what pushes it.
TEST(SceneBodies, WhatPushesWaitsBeforeABlockedBody)
{
  const Mesh floor(test::planeMesh()), crate(test::crateMesh(1, 1, 1)), hand(test::crateMesh(0.2, 0.6, 0.6));
  SceneOptions options;
  options.effects.any = true;
  Scene scene(options);
  scene.add(fixedObject("floor", floor.hierarchy));
  scene.add(fixedObject("wall", crate.hierarchy, at(1.2, 0, 0.501)));
  SceneObject pusher = object("hand", hand.hierarchy, at(-0.8, 0, 0.5));
  pusher.motion = WaypointMotion{{0, 2}, {at(-0.8, 0, 0.5), at(1.2, 0, 0.5)}};
  scene.add(std::move(pusher));
  scene.add(object("crate", crate.hierarchy, at(0, 0, 0.501)));
  const auto bodies = makeSceneBodies(scene, {}, {ground(), ground(), ground(), ofMass(100, {0.3, 0})});
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(bodies->step(0.1).scene.any.empty()) << i;
    EXPECT_LT(bodies->states()[0].velocity.norm(), 3.0) << i << ": the hand wants to catch up, at 2 m/s at most";
  }
  EXPECT_LT(scene[3].pose.translation().x(), 0.2);
  EXPECT_NEAR(scene[3].pose.translation().x(), 0.2, 0.01);
  EXPECT_LT(scene[2].pose.translation().x(), -0.4);
}

/// A part that is elsewhere in its object: the object's pose follows the part's.
TEST(SceneBodies, PartsMayStandApartFromTheirObject)
{
  const Mesh crate(test::crateMesh(1, 1, 1));
  SceneObject moved = object("crate", crate.hierarchy, at(3, 0, 0));
  moved.parts[0].pose = Eigen::Isometry3d(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX())) * at(0, 2, 0);
  Scene scene{SceneOptions{}};
  scene.add(std::move(moved));
  const Eigen::Isometry3d before = scene.worldPose(0);
  const auto bodies = makeSceneBodies(scene, {}, {ofMass(1)});
  bodies->step(0.5);
  const Eigen::Vector3d fallen(0, 0, 0.5 * kGravity * 0.5 * (0.5 + kStep));
  EXPECT_LT((before.translation() - fallen - scene.worldPose(0).translation()).norm(), 1e-4);
  EXPECT_LT((at(3, 0, -fallen.z()).matrix() - scene[0].pose.matrix()).norm(), 1e-4);
}

/// Bodies that begin in each other are told, and come apart no faster than they may.
TEST(SceneBodies, ThatBeginInEachOtherAreToldAndPushedApart)
{
  const Mesh slab(test::crateMesh(4, 4, 1)), crate(test::crateMesh(1, 1, 1));
  Scene scene{SceneOptions{}};
  SceneObject floor = fixedObject("floor", slab.hierarchy, at(0, 0, -0.5));
  floor.parts[0].solid = true;
  scene.add(std::move(floor));
  scene.add(object("crate", crate.hierarchy, at(0.2, 0.1, 0.4))); // 0.1 deep
  scene.add(object("near", crate.hierarchy, at(-1.2, 0.1, 0.51)));
  const Cloud coarse(std::vector<float>{9, 0, 0, 9.5, 0, 0, 9, 0.5, 0}); // clouds rest far apart, meshes do not
  scene.add(fixedObject("coarse", coarse.hierarchy));
  BodiesOptions options;
  options.most_push = 0.2;
  const auto bodies = makeSceneBodies(scene, options, {ground(), ofMass(100), ofMass(1), ground()});
  ASSERT_EQ(bodies->warnings().size(), 1u);
  EXPECT_EQ(bodies->warnings()[0], "objects 'floor' and 'crate' begin in each other, at a distance of -0.1 where they "
                                   "rest at 0.001: they are pushed apart by 0.2 in a second at most");
  double fastest = 0.0;
  for (int i = 0; i < 60; ++i) {
    bodies->step(1.0 / 60);
    fastest = std::max(fastest, bodies->states()[0].velocity.z());
  }
  EXPECT_LT(fastest, 0.25);
  EXPECT_NEAR(scene[1].pose.translation().z(), 0.501, 0.002);
}

TEST(SceneBodies, ComeOutOfASolidThatHoldsThem)
{
  const Mesh slab(test::crateMesh(4, 4, 1)), crate(test::crateMesh(0.2, 0.2, 0.2));
  Scene scene{SceneOptions{}};
  SceneObject floor = fixedObject("floor", slab.hierarchy, at(0, 0, -0.5));
  floor.parts[0].solid = true;
  scene.add(std::move(floor));
  scene.add(object("crate", crate.hierarchy, at(0.2, 0.1, -0.3)));
  const auto bodies = makeSceneBodies(scene, {}, {ground(), ofMass(100)});
  ASSERT_EQ(bodies->warnings().size(), 1u);
  EXPECT_THAT(bodies->warnings()[0], HasSubstr("'floor' and 'crate' begin in each other"));
  for (int i = 0; i < 20; ++i) {
    bodies->step(0.1);
    EXPECT_LT(bodies->states()[0].velocity.norm(), 1.01) << i;
  }
  EXPECT_NEAR(scene[1].pose.translation().z(), 0.101, 0.002);
}

TEST(SceneBodies, RefusesWhatHasNoMeaning)
{
  const Mesh floor(test::planeMesh()), crate(test::crateMesh(1, 1, 1));
  const Cloud points(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [&](const SceneBody& body, const BodiesOptions& options = {}, const Effects& effects = {},
                           const std::shared_ptr<SphereHierarchy>& of = nullptr) {
    SceneOptions of_scene;
    of_scene.effects = effects;
    Scene scene(of_scene);
    scene.add(object("crate", of ? of : crate.hierarchy, at(0, 0, 5)));
    return refusalOf([&] { makeSceneBodies(scene, options, {body}); });
  };
  SceneBody both = ofMass(1), inert = ofMass(1), weightless;
  both.density = 1.0;
  inert.inertia = Eigen::Vector3d(1, nan, 1);
  weightless.inertia = Eigen::Vector3d(1, 1, 1);
  EXPECT_EQ(refusal({}), "bodies: no object is one: give a mass or a density to what shall fall");
  EXPECT_EQ(refusal(both), "bodies: object 'crate' has both a mass and a density: leave one out");
  EXPECT_THAT(refusal(weightless), HasSubstr("no object is one"));
  EXPECT_THAT(refusal(inert), HasSubstr("object 'crate': inertia: "));
  for (const double mass : {0.0, -1.0, nan}) EXPECT_THAT(refusal(ofMass(mass)), HasSubstr("object 'crate': mass: "));
  for (const double density : {0.0, -1.0, nan})
    EXPECT_THAT(refusal(heavy(density)), HasSubstr("object 'crate': density")) << density;
  EXPECT_THAT(refusal(ofMass(1, {-1, 0})), HasSubstr("object 'crate': friction: -1"));
  EXPECT_THAT(refusal(ofMass(1, {1, 1.5})), HasSubstr("object 'crate': restitution: 1.5"));
  EXPECT_THAT(refusal(ofMass(1), {}, {}, floor.hierarchy), HasSubstr("object 'crate': "));
  EXPECT_THAT(refusal(ofMass(1), {}, {}, floor.hierarchy), HasSubstr("open"));
  EXPECT_EQ(refusal(heavy(1), {}, {}, points.hierarchy),
            "object 'crate': density: is of points, which enclose nothing: give the mass");
  EXPECT_EQ(refusal(ofMass(1), {}, {}, points.hierarchy), "");
  for (const double step : {0.0, -1.0, nan}) {
    BodiesOptions options;
    options.step = step;
    EXPECT_THAT(refusal(ofMass(1), options), HasSubstr("is not finite and > 0")) << step;
  }
  BodiesOptions gravity;
  gravity.gravity.x() = nan;
  EXPECT_THAT(refusal(ofMass(1), gravity), HasSubstr("gravity: not finite"));
  for (std::size_t e = 0; e < kEffects; ++e) {
    Effects effects;
    const auto effect = static_cast<Effect>(e);
    effects.first_contact = effect == Effect::first_contact;
    effects.swept = effect == Effect::swept;
    effects.response = effect == Effect::stop    ? Response::stop
                       : effect == Effect::slide ? Response::slide
                                                 : Response::none;
    if (effect == Effect::gravity) effects.gravity = Gravity{};
    if (effect == Effect::deform) effects.deform = 2.0;
    const std::string expected = effects.none() ? ""
                                                : std::string("bodies: the effect '") + nameOf(effect) +
                                                      "' does not go with them: leave one out";
    EXPECT_EQ(refusal(ofMass(1), {}, effects), expected);
  }
}

TEST(SceneBodies, RefusesObjectsThatCannotBeBodies)
{
  const Mesh crate(test::crateMesh(1, 1, 1));
  const auto refusal = [&](const SceneBody& body, const auto& change) {
    Scene scene{SceneOptions{}};
    SceneObject other = object("crate", crate.hierarchy);
    change(other);
    scene.add(std::move(other));
    scene.add(object("falls", crate.hierarchy, at(9, 0, 0)));
    return refusalOf([&] { makeSceneBodies(scene, {}, {body, ofMass(1)}); });
  };
  const auto moving = [](SceneObject& other) { other.motion = VelocityMotion{{1, 0, 0}, {0, 0, 0}}; };
  const auto parts = [](SceneObject& other) { other.parts.push_back(other.parts[0]); };
  SceneBody weightless;
  weightless.inertia = Eigen::Vector3d(1, 1, 1);
  EXPECT_THAT(refusal(weightless, [](SceneObject&) {}), HasSubstr("has an inertia and no mass"));
  EXPECT_THAT(refusal(ofMass(1), [](SceneObject& other) { other.fixed = true; }), HasSubstr("is a body and fixed"));
  EXPECT_THAT(refusal(ofMass(1), moving), HasSubstr("is a body and has a motion"));
  EXPECT_THAT(refusal(ofMass(1), parts), HasSubstr("is a body and has several parts"));
  EXPECT_EQ(refusal(ground(), parts), "");
  EXPECT_THAT(refusal(ground(),
                      [&](SceneObject& other) {
                        moving(other);
                        parts(other);
                      }),
              HasSubstr("has a motion and several parts"));
  Scene scene{SceneOptions{}};
  scene.add(object("crate", crate.hierarchy));
  EXPECT_THAT(refusalOf([&] { makeSceneBodies(scene, {}, {}); }), HasSubstr("0 for 1 objects"));
  const auto bodies = makeSceneBodies(scene, {}, {ofMass(1)});
  for (const double dt : {-1.0, std::numeric_limits<double>::quiet_NaN(), 1e9})
    EXPECT_THAT(refusalOf([&] { bodies->step(dt); }), HasSubstr("at most a million")) << dt;
  EXPECT_EQ(bodies->step(0).steps, 0u);
}

} // namespace
} // namespace pcl_bsh
