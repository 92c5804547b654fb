// SPDX-License-Identifier: BSD-3-Clause
// The motion since the last query, whatever else has happened since.
#include <pcl_bsh/scene/scene.h>

#include "scene_worlds.h"
#include "swept_twin.h"

#include <pcl_bsh/scene/swept/object_motion.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace pcl_bsh {
namespace {

using test::at;
using test::Cloud;
using test::Layout;
using test::Random;
using test::sheet;
using test::Shelf;
using test::SweptTwin;

constexpr Layout doubles{Scalar::float64, 0, 0};

SceneOptions sweeping()
{
  SceneOptions options;
  options.effects.first_contact = options.effects.swept = true;
  options.effects.deform = 1.5;
  options.clearance = 0.05;
  return options;
}

/// A plate at x = 1, and a dot that flies from x = 0 to x = 2 in a second.
struct DotAndPlate {
  explicit DotAndPlate(const SceneOptions& options = sweeping()) : scene(options)
  {
    scene.add(fixedObject("plate", shelf.add(sheet({1, -0.5, -0.5}, {0, 0.05, 0}, {0, 0, 0.05}, 21, 21))));
  }

  ObjectId addDot()
  {
    SceneObject made = object("dot", dot);
    made.motion = VelocityMotion{{2, 0, 0}};
    return scene.add(made);
  }

  void expectHit(const SceneResult& result, double fraction = 0.95 / 2) const
  {
    ASSERT_EQ(result.first_contact.size(), 1u);
    EXPECT_NEAR(result.first_contact[0].fraction, fraction, 1e-4);
    EXPECT_EQ(result.certain_contact.size(), 1u);
    EXPECT_EQ(result.swept.size(), 2u);
  }

  Shelf shelf;
  Cloud here{{{0, 0, 0}}, doubles}, there{{{0, 0.1, 0}}, doubles};
  std::shared_ptr<SphereHierarchy> dot = std::make_shared<SphereHierarchy>(here.view());
  Scene scene;
};

TEST(SweptObject, TheFirstStepNeedsNoQueryBefore)
{
  DotAndPlate world;
  const ObjectId dot = world.addDot();
  const SceneResult result = world.scene.step(1);
  world.expectHit(result);
  ASSERT_EQ(result.swept_motions.size(), 1u);
  EXPECT_EQ(result.swept_motions[0].object, dot);
  EXPECT_EQ(result.swept_motions[0].leg.from.matrix(), at(0, 0, 0).matrix());
  EXPECT_TRUE(result.unswept.empty());
}

TEST(SweptObject, BeforeItsFirstQueryAPoseIsWhereAnObjectIsPut)
{
  DotAndPlate world;
  const ObjectId dot = world.addDot();
  world.scene.setPose(dot, at(3, 0, 0)); // beyond the plate
  EXPECT_TRUE(world.scene.step(1).first_contact.empty());
  world.scene.setPose(dot, at(-1, 0, 0)); // and back through it
  world.expectHit(world.scene.query(), 3.95 / 6);
}

TEST(SweptObject, AnObjectThatWasAddedIsSweptByAStepAndMarkedByAQuery)
{
  for (const bool step : {true, false}) {
    DotAndPlate world;
    EXPECT_TRUE(world.scene.query().unswept.empty()); // nothing was before
    const ObjectId dot = world.addDot();
    if (step) {
      const SceneResult result = world.scene.step(1);
      world.expectHit(result);
      EXPECT_TRUE(result.unswept.empty());
    }
    else {
      const SceneResult result = world.scene.query();
      EXPECT_TRUE(result.swept_motions.empty());
      ASSERT_EQ(result.unswept.size(), 1u);
      EXPECT_EQ(result.unswept[0].object, dot);
      EXPECT_TRUE(result.unswept[0].added);
      EXPECT_FALSE(result.unswept[0].reshaped || result.unswept[0].detoured);
    }
    EXPECT_TRUE(world.scene.query().unswept.empty());
  }
}

TEST(SweptObject, ChangedPointsAreSweptAsTheyAreAndMarked)
{
  Scene other(sweeping());
  const std::function<void(DotAndPlate&, ObjectId)> changes[] = {
      [](DotAndPlate& world, ObjectId dot) { world.scene.deform(dot, 0, world.there.view()); },
      [](DotAndPlate& world, ObjectId dot) { world.scene.pointsChanged(dot); },
      [](DotAndPlate& world, ObjectId) { world.dot->refit(world.there.view()); },
      [](DotAndPlate& world, ObjectId) { *world.dot = SphereHierarchy(world.there.view()); },
      [&](DotAndPlate& world, ObjectId) {
        const ObjectId shared = other.add(object("shared", world.dot));
        other.deform(shared, 0, world.there.view());
      },
  };
  for (const auto& change : changes) {
    DotAndPlate world;
    const ObjectId dot = world.addDot();
    world.scene.query();
    change(world, dot);
    const SceneResult result = world.scene.step(1);
    world.expectHit(result);
    ASSERT_EQ(result.unswept.size(), 1u);
    EXPECT_EQ(result.unswept[0].object, dot);
    EXPECT_TRUE(result.unswept[0].reshaped);
    EXPECT_FALSE(result.unswept[0].added || result.unswept[0].detoured);
    EXPECT_TRUE(world.scene.step(1).unswept.empty());
  }
}

TEST(SweptObject, WhatDeformsInEveryStepIsSweptInEveryStep)
{
  DotAndPlate world;
  const ObjectId dot = world.addDot();
  std::size_t hits = 0;
  for (int step = 0; step < 10; ++step) {
    world.scene.deform(dot, 0, (step % 2 == 0 ? world.there : world.here).view());
    hits += world.scene.step(0.2).first_contact.size(); // x = 0.8 to 1.2 is one of them
  }
  EXPECT_EQ(hits, 1u);
}

TEST(SweptObject, APartWhosePoseWasSetGoesByALegOfItsOwn)
{
  DotAndPlate world;
  SceneObject robot;
  robot.name = "robot";
  robot.parts = {{"base", world.dot, Eigen::Isometry3d::Identity()}, {"arm", world.dot, at(0, 0.1, 0)}};
  const ObjectId id = world.scene.add(robot);
  world.scene.query();
  world.scene.setPartPose(id, 1, at(2, 0.1, 0));
  const SceneResult result = world.scene.query();
  world.expectHit(result);
  EXPECT_EQ(result.first_contact[0].part_b, 1u);
  EXPECT_TRUE(result.unswept.empty());
  ASSERT_EQ(result.swept_motions.size(), 2u);
  EXPECT_EQ(result.swept_motions[0].part, std::nullopt);
  EXPECT_EQ(result.swept_motions[1].part, 1u);
  EXPECT_EQ(result.swept_motions[1].leg.from.matrix(), at(0, 0.1, 0).matrix());
  EXPECT_TRUE(world.scene.query().swept_motions.empty());

  world.scene.setPartPose(id, 1, at(2, 0.1, 0.1)); // beside the plate
  world.scene.setMotion(id, VelocityMotion{{2, 0, 0}});
  const SceneResult moved = world.scene.step(1); // the base meets it
  world.expectHit(moved);
  EXPECT_EQ(moved.first_contact[0].part_b, 0u);
  ASSERT_EQ(moved.unswept.size(), 1u);
  EXPECT_TRUE(moved.unswept[0].detoured) << "the part was set, then moved on with its object";
}

TEST(SweptObject, APartWithoutPointsGoesByALegOfItsOwnToo)
{
  DotAndPlate world;
  SceneObject robot;
  robot.name = "robot";
  robot.parts = {{"base", world.dot, Eigen::Isometry3d::Identity()},
                 {"empty", world.shelf.add(std::vector<Point3>()), at(0, 0.1, 0)}};
  const ObjectId id = world.scene.add(robot);
  world.scene.query();
  world.scene.setPartPose(id, 1, at(2, 0.1, 0));
  const SceneResult result = world.scene.query();
  EXPECT_TRUE(result.first_contact.empty());
  ASSERT_EQ(result.swept_motions.size(), 2u);
  EXPECT_EQ(result.swept_motions[1].part, 1u);
  EXPECT_EQ(result.swept_motions[1].leg.center, Eigen::Vector3d::Zero());
  EXPECT_EQ(result.swept_motions[1].leg.to.matrix(), at(2, 0.1, 0).matrix());
}

TEST(SweptObject, APoseThatIsSetBeforeAStepIsMarkedWhereTheObjectMovesOn)
{
  DotAndPlate world;
  const ObjectId dot = world.addDot();
  world.scene.query();
  world.scene.setPose(dot, at(0, 2, 0));
  const SceneResult result = world.scene.step(1); // one leg from (0, 0) to (2, 2), past the plate
  EXPECT_TRUE(result.first_contact.empty());
  ASSERT_EQ(result.unswept.size(), 1u);
  EXPECT_TRUE(result.unswept[0].detoured);
  world.scene.setMotion(dot, NoMotion{});
  world.scene.setPose(dot, at(0, 0, 0));
  EXPECT_TRUE(world.scene.step(1).unswept.empty()); // its leg is all it did
}

TEST(SweptObject, AResponseThatLeadsAnObjectAnotherWayIsMarked)
{
  SceneOptions options = sweeping();
  options.effects.response = Response::slide;
  DotAndPlate world(options);
  const ObjectId dot = world.addDot();
  EXPECT_TRUE(world.scene.step(0.1).unswept.empty());
  world.scene.setMotion(dot, VelocityMotion{{2, 0.2, 0}});
  const SceneResult result = world.scene.step(1); // up to the plate, and along it
  ASSERT_EQ(result.outcomes.size(), 1u);
  ASSERT_GT(result.outcomes[0].legs.size(), 1u);
  ASSERT_EQ(result.unswept.size(), 1u);
  EXPECT_TRUE(result.unswept[0].detoured);
}

TEST(SweptObject, AStepThatThrowsForgetsNoMotion)
{
  DotAndPlate world;
  const ObjectId dot = world.addDot();
  world.scene.query();
  world.scene.setPose(dot, at(2, 0, 0));
  world.scene.deform(dot, 0, world.there.view());
  world.scene.setMotion(dot, VelocityMotion{{1e12, 0, 0}});
  EXPECT_THROW(world.scene.step(1), std::invalid_argument);
  const SceneResult result = world.scene.query();
  world.expectHit(result);
  ASSERT_EQ(result.unswept.size(), 1u);
  EXPECT_TRUE(result.unswept[0].reshaped);
  EXPECT_FALSE(result.unswept[0].detoured);
}

/// As in the usage of scene.h: steps alone, a response, and nobody asks before the first.
TEST(SweptObject, TheUsageOfASceneMeetsWhatItMeets)
{
  Shelf shelf;
  SceneOptions options;
  options.clearance = 0.02;
  options.effects.any = options.effects.first_contact = true;
  Scene scene(options);
  scene.add(fixedObject("hall", shelf.add(sheet({1, -0.5, -0.5}, {0, 0.02, 0}, {0, 0, 0.02}, 51, 51))));
  const ObjectId visitor = scene.add(object("visitor", shelf.add({{0, 0, 0}})));
  scene.setMotion(visitor, VelocityMotion{{1.2, 0, 0}});
  std::size_t contacts = 0;
  for (int i = 0; i < 3; ++i) contacts += scene.step(1).first_contact.size();
  EXPECT_EQ(contacts, 1u);
}

// --- random worlds ---

/// Two scenes of the same clouds, and all that the interface offers done to them in any order.
class ChangingWorlds {
public:
  ChangingWorlds(std::uint64_t seed, bool uncertain) : random(seed), uncertain_(uncertain)
  {
    for (int i = 0; i < 4; ++i) {
      shapes_.push_back(shape(i));
      clouds_.push_back(std::make_shared<SphereHierarchy>(shapes_.back().view()));
    }
    for (int i = 0; i < 2; ++i) {
      SceneOptions options = sweeping();
      const int kind = random.integer(0, 4);
      options.effects.any = random.chance(0.3);
      options.effects.response = kind == 3 ? Response::stop : kind == 4 ? Response::slide : Response::none;
      if (random.chance(0.15)) options.effects.gravity = Gravity{0.2, {0, 0, -1}};
      options.clearance = random.chance(0.2) ? 0.0 : random.uniform(0.02, 0.2);
      options.tolerance = random.chance(0.5) ? 1e-4 : 1e-3;
      options.test_pairs = random.chance(0.9);
      options.threads = random.chance(0.3) ? 2 : 1;
      options.remember = random.chance(0.7);
      scenes_.emplace_back(options);
    }
    for (Scene& scene : scenes_) {
      twins_.emplace_back(scene);
      for (int i = random.integer(1, 4); i >= 0; --i) add(scene);
    }
  }

  /// @return what is wrong, empty if nothing is
  std::string change()
  {
    const auto which = static_cast<std::size_t>(random.integer(0, 1));
    Scene& scene = scenes_[which];
    SweptTwin& twin = twins_[which];
    const auto id = static_cast<ObjectId>(random.integer(0, static_cast<int>(scene.size()) - 1));
    const auto part = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(scene[id].parts.size()) - 1));
    const auto cloud = static_cast<std::size_t>(random.integer(0, 3));
    PairRule rule;
    if (random.chance(0.5)) rule.tested = random.chance(0.6);
    if (random.chance(0.5)) rule.clearance = random.uniform(0, 0.4);
    switch (random.integer(0, 16)) {
    case 0:
      if (scene.size() < 7) add(scene);
      return {};
    case 1:
    case 2:
      scene.setPose(id, random.chance(0.2) ? scene[id].pose : random.pose(1.5));
      return {};
    case 3:
      scene.setPartPose(id, part, random.chance(0.2) ? scene[id].parts[part].pose : random.pose(0.8));
      return {};
    case 4:
      shapes_.push_back(shape(-1));
      scene.deform(id, part, shapes_.back().view());
      return tellOf(scene[id].parts[part].hierarchy.get());
    case 5:
      shapes_.push_back(shape(-1));
      clouds_[cloud]->refit(shapes_.back().view());
      return tellOf(clouds_[cloud].get());
    case 6:
      twin.pointsChanged(id);
      return {};
    case 7:
    case 8:
      scene.setMotion(id, motion(scene[id].pose));
      return {};
    case 9:
      if (id > 0) twin.setRule(id, id - 1, rule);
      return {};
    case 10:
      twin.setGroupRule(rule);
      return {};
    case 11:
    case 12:
      return twin.query();
    default:
      return twin.step(random.chance(0.1) ? 0.0 : random.uniform(0.1, 1.0));
    }
  }

  const std::deque<SweptTwin>& twins() const { return twins_; }

private:
  static constexpr std::size_t kPoints = 9;

  Cloud shape(int kind)
  {
    std::vector<Point3> points = kind == 0 ? sheet({0, -0.3, -0.3}, {0, 0.3, 0}, {0, 0, 0.3}, 3, 3)
                                           : test::makePoints(test::Shape::uniform, kPoints, 0.3, random);
    Cloud cloud(points, doubles);
    if (rounded_) cloud.setRadii(std::vector<float>(kPoints, 0.03f));
    if (uncertain_ && random.chance(0.5)) test::makeUncertain(cloud, 0.1, random);
    return cloud;
  }

  void add(Scene& scene)
  {
    SceneObject object;
    object.name = "object " + std::to_string(scene.size());
    object.group = random.chance(0.4) ? "some" : "";
    object.pose = random.pose(1.5);
    object.fixed = random.chance(0.25);
    for (int i = random.chance(0.4) ? 1 : 0; i >= 0; --i)
      object.parts.push_back({"part", clouds_[static_cast<std::size_t>(random.integer(0, 3))],
                              i == 0 ? Eigen::Isometry3d::Identity() : random.pose(0.4)});
    if (!object.fixed && random.chance(0.7)) object.motion = motion(object.pose);
    scene.add(object);
  }

  Motion motion(const Eigen::Isometry3d& pose)
  {
    const auto vector = [&](double size) {
      const Point3 p = random.point([&] { return random.uniform(-size, size); });
      return Eigen::Vector3d(p[0], p[1], p[2]);
    };
    if (random.chance(0.1)) return NoMotion{};
    if (random.chance(0.15)) return CircularMotion{vector(1), vector(1), random.uniform(-8, 8), random.chance(0.7)};
    if (random.chance(0.15)) return WaypointMotion{{0, 0.7, 1.5, 3}, {pose, random.pose(1), random.pose(1), pose}};
    return VelocityMotion{random.uniform(0.5, 2) * (vector(0.3) - pose.translation()),
                          random.chance(0.5) ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : vector(5)};
  }

  std::string tellOf(const SphereHierarchy* hierarchy)
  {
    for (SweptTwin& twin : twins_) twin.pointsChanged(hierarchy);
    return {};
  }

  Random random;
  bool uncertain_;
  bool rounded_ = random.chance(0.3); // a cloud has radii before and after a refit, or never
  std::deque<Cloud> shapes_;
  std::vector<std::shared_ptr<SphereHierarchy>> clouds_;
  std::deque<Scene> scenes_;
  std::deque<SweptTwin> twins_;
};

TEST(SweptObject, NoChangeHidesAMotion)
{
  std::size_t contacts = 0, certain = 0, own_legs = 0, added = 0, reshaped = 0, detoured = 0;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ChangingWorlds worlds(900 + seed, seed % 2 == 1);
    for (int change = 0; change < 60; ++change) ASSERT_EQ(worlds.change(), "") << "change " << change;
    for (const SweptTwin& twin : worlds.twins()) {
      contacts += twin.contacts;
      certain += twin.certain_contacts;
      own_legs += twin.own_legs;
      added += twin.added;
      reshaped += twin.reshaped;
      detoured += twin.detoured;
    }
  }
  EXPECT_GT(contacts, 500u);
  EXPECT_GT(contacts, certain);
  EXPECT_GT(certain, 400u);
  EXPECT_GT(own_legs, 100u);
  EXPECT_GT(added, 10u);
  EXPECT_GT(reshaped, 100u);
  EXPECT_GT(detoured, 100u);
}

/// By more than half a turn, which poses alone do not tell.
TEST(SweptObject, TurnsAsItsResponseLedIt)
{
  for (const Response response : {Response::none, Response::stop, Response::slide}) {
    SceneOptions options;
    options.effects.first_contact = true;
    options.effects.response = response;
    Scene scene(options);
    const Cloud bar({{0, 0, 0}, {0.5, 0, 0}}, doubles);
    SceneObject made = object("bar", std::make_shared<SphereHierarchy>(bar.view()));
    made.motion = VelocityMotion{{1, 0, 0}, {0, 0, 4}};
    scene.add(std::move(made));
    const SceneResult result = scene.step(1);
    ASSERT_EQ(result.swept_motions.size(), 1u);
    EXPECT_TRUE(result.swept_motions[0].leg.turn.isApprox(Eigen::Vector3d(0, 0, 4), 1e-12))
        << static_cast<int>(response);
  }
}

/// More pairs than are told apart, which come no nearer than within the clearance: both sides are flagged all the same.
TEST(SweptObject, ACrowdThatPassesACrowdIsFlaggedOnBothSides)
{
  std::vector<Point3> moving(300, Point3{0, 0, 0}), fixed = moving;
  moving.push_back({0, 5, 0});
  fixed.push_back({0, -5, 0});
  const Cloud a(moving, doubles), b(fixed, doubles);
  SceneOptions options;
  options.effects.swept = true;
  options.clearance = 0.5;
  options.tolerance = 0.05;
  Scene scene(options);
  SceneObject swarm = object("swarm", std::make_shared<SphereHierarchy>(a.view()), at(-3, 0.4, 0));
  swarm.motion = VelocityMotion{{6, 0, 0}};
  scene.add(swarm);
  scene.add(fixedObject("still", std::make_shared<SphereHierarchy>(b.view())));
  const SceneResult result = scene.step(1);
  ASSERT_EQ(result.swept.size(), 2u);
  for (const FlaggedPart& part : result.swept) {
    EXPECT_EQ(part.colliding, 300u) << part.object;
    EXPECT_EQ(part.flags.back(), Verdict::free) << part.object;
  }
}

/// Both the shift and the turn count, of points at the corners of the box.
TEST(ObjectMotion, NoPointIsFasterThanItsSpeed)
{
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    Leg leg;
    leg.turn = random.uniform(0, 8) * axis.normalized();
    leg.to.linear() = Eigen::AngleAxisd(leg.turn.norm(), leg.turn.normalized()).toRotationMatrix();
    leg.center = Eigen::Vector3d(random.uniform(-1, 1), 0, 0);
    leg.to.translation() = Eigen::Vector3d{random.uniform(-3, 3), random.uniform(-3, 3), 0};
    const Box3 box{{-1, -2, -3}, {1, 2, 3}};
    const ObjectMotion motion(leg, box);
    double fastest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 2 : -2, (corner & 4) != 0 ? 3 : -3);
      for (int step = 0; step < 64; ++step)
        fastest = std::max(fastest, (leg.at((step + 1) / 64.0) * p - leg.at(step / 64.0) * p).norm() * 64.0);
    }
    EXPECT_GE(motion.speed(), fastest * (1.0 - 1e-12));
    EXPECT_GE(motion.rounding(), 64 * kDoubleUnit * fastest);
  }
}

} // namespace
} // namespace pcl_bsh
