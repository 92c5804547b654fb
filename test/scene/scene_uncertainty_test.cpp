// SPDX-License-Identifier: BSD-3-Clause
// Scenes of points that may be elsewhere than they were measured.
#include <pcl_bsh/scene/scene.h>

#include "random_world.h"
#include "support/verdicts.h"
#include "watched_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace pcl_bsh {
namespace {

using test::at;
using test::Cloud;
using test::expectAnyAsBruteForce;
using test::expectDistancesAsBruteForce;
using test::expectFlagsAsBruteForce;
using test::expectSelfAsBruteForce;
using test::Layout;
using test::RandomWorld;
using test::Shelf;
using test::WatchedMotion;

constexpr Layout doubles{Scalar::float64, 0, 0};

TEST(SceneUncertainty, SameAsBruteForceInAllStepsWhateverIsRemembered)
{
  std::size_t undecided = 0, colliding = 0, points = 0, reused = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomWorld world(seed, true);
    Effects effects;
    effects.any = seed % 4 != 3;
    effects.flags = effects.self = true;
    effects.distance = 0.2;
    Scene scene = world.scene(effects, static_cast<unsigned>(seed % 2) + 1, seed % 3 != 2);
    for (int step = 0; step < 6; ++step) {
      SCOPED_TRACE("step " + std::to_string(step));
      const SceneResult result = scene.query();
      if (effects.any) expectAnyAsBruteForce(world, scene, result);
      expectFlagsAsBruteForce(world, scene, result);
      expectDistancesAsBruteForce(world, scene, result, *effects.distance);
      expectSelfAsBruteForce(scene, result);
      if (HasFailure()) return;
      undecided += result.undecided.size();
      colliding += result.any.size();
      reused += result.cost(Effect::any).reused;
      for (const FlaggedPart& part : result.flags) points += part.undecided;
      world.shuffle({&scene});
    }
  }
  EXPECT_GT(undecided, 20u);
  EXPECT_GT(colliding, 12u);
  EXPECT_GT(points, 100u);
  EXPECT_GT(reused, 60u);
}

/// Points off by up to 0.1, mostly one, and another that is off by up to 0.3; this one may move along x.
struct TwoPoints {
  TwoPoints(double distance, const Effects& effects, double speed = 0.0, double tolerance = 1e-4,
            const std::vector<Point3>& at_rest = {{0, 0, 0}})
  {
    Cloud fixed(at_rest, doubles), moving({{0, 0, 0}}, doubles);
    fixed.setUncertainties(0.1, {});
    moving.setUncertainties(0.1, {0.2f});
    SceneOptions options;
    options.effects = effects;
    options.clearance = clearance;
    options.tolerance = tolerance;
    scene = std::make_unique<Scene>(options);
    scene->add(fixedObject("fixed", shelf.add(std::move(fixed))));
    SceneObject object = pcl_bsh::object("moving", shelf.add(std::move(moving)), at(-3.0 * (speed > 0), distance, 0));
    if (speed > 0) object.motion = VelocityMotion{{speed, 0, 0}};
    scene->add(std::move(object));
  }

  static constexpr double clearance = 0.5;
  Shelf shelf;
  std::unique_ptr<Scene> scene;
};

/// The largest double at which two points are within clearance + sign * uncertainties, 0.1 + 0.1 + float(0.2).
double edge(double sign)
{
  const long double exact =
      0.5L + static_cast<long double>(sign) * (2.0L * static_cast<long double>(0.1) + static_cast<long double>(0.2f));
  auto nearest = static_cast<double>(exact);
  if (static_cast<long double>(nearest) > exact) nearest = std::nextafter(nearest, 0.0);
  return nearest;
}

TEST(SceneUncertainty, BothEdgesToTheLastBit)
{
  Effects effects;
  effects.any = effects.flags = true;
  const double infinity = std::numeric_limits<double>::infinity();
  const auto verdicts = [&](double distance) {
    const SceneResult result = TwoPoints(distance, effects).scene->query();
    const std::size_t colliding = result.any.size(), undecided = result.undecided.size();
    std::size_t flags = 0;
    for (const FlaggedPart& part : result.flags) flags += test::numberOf(part.flags[0]);
    EXPECT_EQ(flags, 2 * colliding + 4 * undecided) << distance;
    return colliding > 0 ? Verdict::colliding : undecided > 0 ? Verdict::undecided : Verdict::free;
  };
  EXPECT_EQ(verdicts(edge(-1.0)), Verdict::colliding);
  EXPECT_EQ(verdicts(std::nextafter(edge(-1.0), infinity)), Verdict::undecided);
  EXPECT_EQ(verdicts(edge(1.0)), Verdict::undecided);
  EXPECT_EQ(verdicts(std::nextafter(edge(1.0), infinity)), Verdict::free);
}

TEST(SceneUncertainty, PointsThatPassByMayCollideOrDoForCertain)
{
  constexpr double tolerance = 1e-6;
  Effects effects;
  effects.swept = effects.first_contact = true;
  const auto pass = [&](double distance) {
    TwoPoints points(distance, effects, 6.0, tolerance);
    points.scene->query();
    const SceneResult result = points.scene->step(1.0);
    const bool near = !result.swept.empty();
    EXPECT_EQ(result.first_contact.size(), near ? 1u : 0u) << distance;
    const Verdict verdict = !near                            ? Verdict::free
                            : result.swept[0].undecided == 1 ? Verdict::undecided
                                                             : Verdict::colliding;
    EXPECT_EQ(result.certain_contact.size(), verdict == Verdict::colliding ? 1u : 0u) << distance;
    const auto expectAt = [&](const std::vector<PartFirstContact>& contacts, double reach) {
      for (const PartFirstContact& contact : contacts) {
        const double x = 6.0 * contact.fraction - 3.0;
        EXPECT_LE(std::hypot(x, distance), reach + 1.01 * tolerance);
        EXPECT_LT(x, -std::sqrt(std::max(0.0, reach * reach - distance * distance)) + 1e-12);
      }
    };
    expectAt(result.first_contact, edge(1.0));
    expectAt(result.certain_contact, edge(-1.0));
    return verdict;
  };
  EXPECT_EQ(pass(0.0), Verdict::colliding);
  EXPECT_EQ(pass(edge(-1.0)), Verdict::colliding);
  EXPECT_EQ(pass(edge(-1.0) + 1.1 * tolerance), Verdict::undecided);
  EXPECT_EQ(pass(0.5), Verdict::undecided);
  EXPECT_EQ(pass(edge(1.0)), Verdict::undecided);
  EXPECT_EQ(pass(edge(1.0) + 1.1 * tolerance), Verdict::free);
}

/// Too many pairs to follow each: what may collide is undecided there, too.
TEST(SceneUncertainty, HeapsThatComeNearMayCollideOrDoForCertain)
{
  SceneOptions options;
  options.effects.swept = options.effects.first_contact = true;
  options.clearance = 0.5;
  options.tolerance = 0.01;
  for (const auto& [end, verdict] :
       {std::pair(-1.0, Verdict::free), {-0.6, Verdict::undecided}, {-0.2, Verdict::colliding}}) {
    SCOPED_TRACE(end);
    Shelf shelf;
    Cloud heap(std::vector<Point3>(200, Point3{0, 0, 0}), doubles);
    heap.setUncertainties(0.1, {});
    const auto points = shelf.add(std::move(heap));
    Scene scene(options);
    scene.add(fixedObject("at rest", points));
    const ObjectId mover = scene.add(object("mover", points, at(-2, 0, 0)));
    scene.query();
    scene.setPose(mover, at(end, 0, 0));
    const SceneResult result = scene.query();
    EXPECT_EQ(result.first_contact.size(), verdict == Verdict::free ? 0u : 1u);
    EXPECT_EQ(result.certain_contact.size(), verdict == Verdict::colliding ? 1u : 0u);
    ASSERT_EQ(result.swept.size(), verdict == Verdict::free ? 0u : 2u);
    for (const FlaggedPart& part : result.swept) EXPECT_EQ(part.flags, std::vector<Verdict>(200, verdict));
  }
}

TEST(SceneUncertainty, NothingCollidesForCertainWhereTheClearanceIsLessThanTheUncertainty)
{
  Effects effects;
  effects.any = effects.flags = effects.swept = effects.first_contact = true;
  Cloud fixed({{0, 0, 0}}, doubles);
  fixed.setUncertainties(0.6, {});
  Shelf shelf;
  SceneOptions options;
  options.effects = effects;
  options.clearance = 0.5;
  Scene scene(options);
  const auto hierarchy = shelf.add(std::move(fixed));
  scene.add(fixedObject("fixed", hierarchy));
  scene.add(object("moving", hierarchy));
  scene.query();
  scene.setPose(1, at(0.1, 0, 0));
  const SceneResult result = scene.query();
  EXPECT_TRUE(result.any.empty());
  EXPECT_EQ(result.undecided.size(), 1u);
  ASSERT_EQ(result.swept.size(), 2u);
  EXPECT_EQ(result.swept[0].undecided, 1u);
  EXPECT_EQ(result.first_contact.size(), 1u);
  EXPECT_TRUE(result.certain_contact.empty());
}

/// The nose is certain, the tail is not: the first certain contact is the nose's.
TEST(SceneUncertainty, WhatIsCertainOfAnObjectThatIsNotAllCertainMeetsForCertain)
{
  for (const bool only_nose : {true, false}) {
    Shelf shelf;
    Cloud tail({{0, 0, 0}}, doubles);
    tail.setUncertainties(0.005, {});
    SceneOptions options;
    options.effects.first_contact = true;
    options.clearance = 0.05;
    Scene scene(options);
    const auto sure = shelf.add({{0, 0, 0}});
    scene.add(fixedObject("post", sure, at(1, 0, 0)));
    SceneObject dart = object("dart", sure);
    dart.parts.push_back({"tail", shelf.add(std::move(tail)), at(-0.5, only_nose ? 1.0 : 0.0, 0)});
    dart.motion = VelocityMotion{{2, 0, 0}};
    scene.add(dart);
    const SceneResult result = scene.step(1);
    ASSERT_EQ(result.first_contact.size(), 1u);
    ASSERT_EQ(result.certain_contact.size(), 1u);
    for (const auto* contact : {&result.first_contact[0], &result.certain_contact[0]}) {
      EXPECT_NEAR(contact->fraction, 0.475, 1e-4);
      EXPECT_EQ(contact->part_b, 0u);
    }
  }
}

/// Just within the tolerance of what may collide, and just beyond that of what does for certain, from the start.
TEST(SceneUncertainty, NoContactIsCertainBeforeItIsPossible)
{
  Shelf shelf;
  SceneOptions options;
  options.effects.first_contact = true;
  options.clearance = 0.5;
  options.tolerance = 1e-3;
  Scene scene(options);
  Cloud point({{0, 0, 0}}, doubles);
  point.setUncertainties(1e-6, {});
  const auto unsure = shelf.add(std::move(point));
  scene.add(fixedObject("still", unsure));
  SceneObject moving = object("moving", unsure, at(-0.5 - 0.5 * options.tolerance, 0, 0));
  moving.motion = VelocityMotion{{1, 0, 0}};
  scene.add(moving);
  const SceneResult result = scene.step(1);
  ASSERT_EQ(result.first_contact.size(), 1u);
  ASSERT_EQ(result.certain_contact.size(), 1u);
  EXPECT_LE(result.first_contact[0].fraction, result.certain_contact[0].fraction);
}

/// So many pairs that they are not followed one by one: those that meet are uncertain, and are none for certain.
TEST(SceneUncertainty, NoPairOfACrowdMeetsForCertainThatOnlyMay)
{
  std::vector<Point3> moving(200, Point3{0, 0, 0}), fixed = moving;
  std::vector<float> crowd(200, 0.3f);
  moving.push_back({-1, 0, 0});
  fixed.push_back({0, 0.3, 0});
  crowd.push_back(0.0f);
  Cloud a(moving, doubles), b(fixed, doubles);
  a.setUncertainties(0.0, crowd);
  b.setUncertainties(0.0, crowd);
  Shelf shelf;
  SceneOptions options;
  options.effects.first_contact = true;
  options.clearance = 0.5;
  options.tolerance = 0.05;
  Scene scene(options);
  SceneObject swarm = object("swarm", shelf.add(std::move(a)), at(-3, 0, 0));
  swarm.motion = VelocityMotion{{6, 0, 0}};
  scene.add(swarm);
  scene.add(fixedObject("still", shelf.add(std::move(b))));
  const SceneResult result = scene.step(1);
  ASSERT_EQ(result.first_contact.size(), 1u);
  EXPECT_NEAR(result.first_contact[0].fraction, (3 - 1.1) / 6, 0.05 / 6);
  ASSERT_EQ(result.certain_contact.size(), 1u);
  EXPECT_NEAR(result.certain_contact[0].fraction, (3 + 0.6) / 6, 0.05 / 6);
  EXPECT_EQ(result.certain_contact[0].pair, (PointPair{200, 200}));
}

TEST(SceneUncertainty, AResponseHaltsBeforeWhatMayCollide)
{
  for (const Response response : {Response::stop, Response::slide}) {
    Effects effects;
    effects.response = response;
    TwoPoints points(0.0, effects, 6.0);
    const SceneResult result = points.scene->step(1.0);
    ASSERT_EQ(result.outcomes.size(), 1u);
    EXPECT_TRUE(result.outcomes[0].touched);
    const double apart = -(*points.scene)[1].pose.translation().x();
    EXPECT_GT(apart, edge(1.0));
    EXPECT_LE(apart, edge(1.0) + 1e-4);
  }
}

TEST(SceneUncertainty, ResponsesMayCollideAtNoInstant)
{
  int touched = 0, stuck = 0;
  for (std::uint64_t seed = 40; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomWorld world(seed, true);
    Effects effects;
    effects.response = seed % 2 == 0 ? Response::stop : Response::slide;
    effects.first_contact = true;
    Scene scene = world.scene(effects);
    for (ObjectId i = 0; i < scene.size(); ++i)
      if (!scene[i].fixed) {
        VelocityMotion motion;
        motion.linear = -0.5 * scene[i].pose.translation();
        if (i % 3 == 0) motion.angular = {0.0, 0.3, 0.4};
        scene.setMotion(i, motion);
      }
    scene.query();
    for (int step = 0; step < 2; ++step) {
      WatchedMotion watch(scene, [&](ObjectId a, ObjectId b) { return world.clearanceOf(a, b); });
      const SceneResult result = scene.step(0.7);
      ASSERT_EQ(watch.replayResponses(result, 150), "") << "step " << step;
      ASSERT_EQ(watch.replayFirstContacts(result, 40), "") << "step " << step;
      for (const Outcome& outcome : result.outcomes) {
        touched += outcome.touched && !outcome.stuck;
        stuck += outcome.stuck;
      }
    }
  }
  EXPECT_GT(touched, 30);
  EXPECT_GT(stuck, 10);
}

/// A pair that may collide at the wider clearance of a look ahead is not free at its own.
TEST(SceneUncertainty, WhatMayCollideFartherAheadIsAskedAgain)
{
  Effects effects;
  effects.any = true;
  std::uint64_t reused = 0;
  for (const double speed : {0.003, 0.01, 0.02}) {
    // Between two points, where boxes are near each other and points are not.
    TwoPoints points(0.0, effects, speed, 1e-4, {{-1, 0, 0}, {1, 0, 0}});
    std::size_t free = 0, undecided = 0, colliding = 0;
    for (double x = -3.0 + speed; x < 3.0; x += speed) {
      const SceneResult result = points.scene->step(1.0);
      const double apart = std::abs(1.0 - std::abs((*points.scene)[1].pose.translation().x()));
      reused += result.cost(Effect::any).reused;
      colliding += result.any.size();
      undecided += result.undecided.size();
      free += result.any.empty() && result.undecided.empty();
      ASSERT_EQ(result.any.size(), apart <= edge(-1.0) ? 1u : 0u) << apart;
      ASSERT_EQ(result.undecided.size(), apart > edge(-1.0) && apart <= edge(1.0) ? 1u : 0u) << apart;
    }
    EXPECT_GT(free, 10u);
    EXPECT_GT(undecided, 5u);
    EXPECT_GT(colliding, 0u);
  }
  EXPECT_GT(reused, 5u);
}

TEST(SceneUncertainty, WhatWasRememberedIsForgottenWithTheUncertainties)
{
  Cloud sure({{0, 0, 0}, {5, 0, 0}}, doubles), unsure = sure, unlike = sure;
  unsure.setUncertainties(0.3, {});
  unlike.setUncertainties(0.0, {0.05f, 0.3f});
  const auto soft = std::make_shared<SphereHierarchy>(sure.view());
  Shelf shelf;
  SceneOptions options;
  options.effects.any = options.effects.flags = true;
  options.effects.deform = 1.5;
  options.clearance = 0.1;
  Scene scene(options);
  scene.add(object("soft", soft));
  scene.add(object("probe", shelf.add({{0, 0.2, 0}})));
  for (int round = 0; round < 3; ++round) {
    SceneResult result = scene.query();
    EXPECT_TRUE(result.any.empty() && result.undecided.empty());
    scene.deform(0, 0, unsure.view());
    result = scene.query();
    EXPECT_TRUE(result.any.empty());
    EXPECT_EQ(result.undecided.size(), 1u);
    EXPECT_EQ(result.flags.size(), 2u);
    scene.deform(0, 0, unlike.view());
    result = scene.query();
    EXPECT_TRUE(result.any.empty() && result.undecided.empty());
    scene.setPose(1, at(0, -0.175, 0)); // within 0.1 - 0.05 of it
    EXPECT_EQ(scene.query().any.size(), 1u);
    scene.deform(0, 0, unsure.view());
    result = scene.query();
    EXPECT_TRUE(result.any.empty()) << "the witness is none for certain any more";
    EXPECT_EQ(result.undecided.size(), 1u);
    scene.setPose(1, at(0, 0, 0));
    scene.deform(0, 0, sure.view());
  }
}

} // namespace
} // namespace pcl_bsh
