// SPDX-License-Identifier: BSD-3-Clause
// Objects, pairs and the effects that only look; what moves by itself is in scene_response_test.cpp.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/scene/scene.h>

#include "random_world.h"
#include "scene_worlds.h"
#include "support/allocations.h"
#include "support/refusal.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using test::at;
using test::expectAnyAsBruteForce;
using test::expectContactsAsQueried;
using test::expectDistancesAsBruteForce;
using test::expectFlagsAsBruteForce;
using test::expectSelfAsBruteForce;
using test::IdPair;
using test::placed;
using test::Random;
using test::RandomWorld;
using test::refusalOf;
using test::Shape;
using test::sheet;
using test::Shelf;
using test::within;
using testing::AllOf;
using testing::HasSubstr;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Scene, SameAsBruteForceOverAllObjectsInAllSteps)
{
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomWorld world(seed);
    Effects effects;
    effects.any = seed % 4 != 3; // flags and contacts use it when it is there
    effects.flags = effects.self = true;
    effects.distance = seed % 3 == 0 ? infinity : 0.2;
    effects.contacts = 3;
    Scene scene = world.scene(effects);
    for (int step = 0; step < 5; ++step) {
      SCOPED_TRACE("step " + std::to_string(step));
      const SceneResult result = scene.query();
      if (effects.any) expectAnyAsBruteForce(world, scene, result);
      expectFlagsAsBruteForce(world, scene, result);
      expectDistancesAsBruteForce(world, scene, result, *effects.distance);
      expectSelfAsBruteForce(scene, result);
      expectContactsAsQueried(world, scene, result, 3);
      if (HasFailure()) return;
      world.shuffle({&scene});
    }
  }
}

// --- accuracy ---

using PartKey = std::pair<IdPair, IdPair>; ///< two objects, their parts

template <class Items>
std::set<IdPair> objectsOf(const Items& items, bool of_self = false)
{
  std::set<IdPair> pairs;
  for (const PartPair& item : items)
    if ((item.a == item.b) == of_self) pairs.insert({item.a, item.b});
  return pairs;
}

/// A pair that is reported is true; a true pair is reported or left open. @return how many were left open
std::size_t expectSubset(const std::set<IdPair>& said, const std::set<IdPair>& open, const std::set<IdPair>& truth)
{
  for (const IdPair& pair : said) EXPECT_TRUE(truth.count(pair) == 1 && open.count(pair) == 0);
  for (const IdPair& pair : truth) EXPECT_TRUE(said.count(pair) + open.count(pair) == 1);
  return open.size();
}

/// @return how many pairs and points were left open
std::size_t expectNoneWrong(const SceneResult& result, const SceneResult& truth)
{
  std::size_t open = expectSubset(objectsOf(result.any), objectsOf(result.undecided), objectsOf(truth.any));

  std::set<PartKey> said, left, so;
  const auto keyOf = [](const PartPair& pair) { return PartKey{{pair.a, pair.b}, {pair.part_a, pair.part_b}}; };
  for (const SelfCollision& hit : result.self) said.insert(keyOf({hit.object, hit.object, hit.part_a, hit.part_b}));
  for (const SelfCollision& hit : truth.self) so.insert(keyOf({hit.object, hit.object, hit.part_a, hit.part_b}));
  for (const PartPair& pair : result.undecided)
    if (pair.a == pair.b) left.insert(keyOf(pair));
  for (const PartKey& key : said) EXPECT_EQ(so.count(key), 1u);
  for (const PartKey& key : so) EXPECT_EQ(said.count(key) + left.count(key), 1u);
  open += left.size();

  std::map<IdPair, std::vector<Verdict>> flags;
  for (const FlaggedPart& part : result.flags) {
    flags[{part.object, part.part}] = part.flags;
    EXPECT_EQ(part.colliding,
              static_cast<std::size_t>(std::count(part.flags.begin(), part.flags.end(), Verdict::colliding)));
    EXPECT_EQ(part.undecided,
              static_cast<std::size_t>(std::count(part.flags.begin(), part.flags.end(), Verdict::undecided)));
    open += part.undecided;
  }
  for (const FlaggedPart& part : truth.flags) {
    EXPECT_EQ(flags.count({part.object, part.part}), 1u);
    std::vector<Verdict>& found = flags[{part.object, part.part}];
    found.resize(part.flags.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_TRUE(found[i] == Verdict::undecided || found[i] == part.flags[i]);
    flags.erase({part.object, part.part});
  }
  for (const auto& entry : flags) // of parts where nothing collides
    EXPECT_EQ(countOf(entry.second, Verdict::colliding), 0u);

  std::map<IdPair, Interval> intervals;
  for (const DistantPair& pair : result.distance) intervals[{pair.a, pair.b}] = pair.interval;
  for (const DistantPair& pair : truth.distance) {
    EXPECT_EQ(intervals.count({pair.a, pair.b}), 1u);
    EXPECT_LE((intervals[{pair.a, pair.b}].lower), pair.distance);
    EXPECT_GE((intervals[{pair.a, pair.b}].upper), pair.distance);
  }
  return open;
}

TEST(SceneAccuracy, NothingIsEverWrong)
{
  std::size_t open = 0;
  for (std::uint64_t seed = 600; seed < 616; ++seed) {
    for (const char* setting : {"level=0", "level=1", "level=100", "pairs=0", "pairs=50", "time=1e-05"}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " at " + setting);
      RandomWorld world(seed), twin(seed);
      Effects effects;
      effects.any = seed % 4 != 3;
      effects.flags = effects.self = true;
      effects.distance = seed % 3 == 0 ? infinity : 0.2;
      effects.contacts = 3;
      Scene exact = world.scene(effects), scene = twin.scene(effects, 1, true, Accuracy::parse(setting));
      for (int step = 0; step < 3; ++step) {
        const SceneResult truth = exact.query(), result = scene.query();
        EXPECT_TRUE(effects.any || objectsOf(result.undecided).empty());
        open += expectNoneWrong(result, truth);
        expectContactsAsQueried(world, exact, result, 3); // exact as ever
        if (HasFailure()) return;
        world.shuffle({&exact, &scene});
      }
    }
  }
  EXPECT_GT(open, 1000u) << "hardly anything was ever undecided";
}

TEST(SceneAccuracy, ToleranceErrsOnlyWithinIt)
{
  for (std::uint64_t seed = 620; seed < 636; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomWorld world(seed);
    Effects effects;
    effects.any = effects.flags = true;
    effects.distance = infinity;
    Scene exact = world.scene(effects), scene = world.scene(effects, 1, true, Accuracy::tolerance(0.05));
    for (int step = 0; step < 3; ++step) {
      const SceneResult truth = exact.query(), result = scene.query();
      const std::set<IdPair> found = objectsOf(result.any);
      for (const IdPair& pair : objectsOf(truth.any)) EXPECT_EQ(found.count(pair), 1u);
      std::map<IdPair, double> distances;
      for (const DistantPair& pair : truth.distance) distances[{pair.a, pair.b}] = pair.distance;
      for (const IdPair& pair : found) EXPECT_LE(distances[pair], *world.clearanceOf(pair.first, pair.second) + 0.05);
      EXPECT_EQ(result.distance.size(), truth.distance.size());
      for (const DistantPair& pair : result.distance) {
        EXPECT_LE(pair.interval.lower, (distances[{pair.a, pair.b}]));
        EXPECT_GE(pair.interval.upper, (distances[{pair.a, pair.b}]));
        EXPECT_LE(pair.distance, (distances[{pair.a, pair.b}] + 0.05 + 1e-12));
      }
      EXPECT_TRUE(result.undecided.empty());
      world.shuffle({&exact, &scene});
    }
  }
}

std::string answers(const SceneResult& result)
{
  std::string text;
  for (const CollidingPair& pair : result.any) text += std::to_string(pair.a) + "x" + std::to_string(pair.b) + " ";
  for (const DistantPair& pair : result.distance)
    text += std::to_string(pair.a) + "-" + std::to_string(pair.b) + ":" + std::to_string(pair.distance) + " ";
  return text;
}

TEST(Scene, RememberingNeverChangesAnAnswer)
{
  std::uint64_t reused = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed) {
    RandomWorld world(seed);
    Effects effects;
    effects.any = true;
    effects.distance = 0.1;
    Scene remembering = world.scene(effects), forgetful = world.scene(effects, 1, false);
    for (int step = 0; step < 15; ++step) {
      const SceneResult result = remembering.query();
      ASSERT_EQ(answers(result), answers(forgetful.query())) << "seed " << seed << ", step " << step;
      reused += result.cost(Effect::any).reused;
      world.shuffle({&remembering, &forgetful});
    }
  }
  EXPECT_GT(reused, 300u);
}

TEST(Scene, SameForAnyNumberOfThreads)
{
  for (std::uint64_t seed = 200; seed < 215; ++seed) {
    RandomWorld world(seed), twin(seed);
    Effects effects;
    effects.any = effects.flags = effects.first_contact = effects.swept = true;
    effects.distance = 0.3;
    effects.contacts = 5;
    Scene one = world.scene(effects), two = twin.scene(effects, 2);
    for (int step = 0; step < 4; ++step) {
      const SceneResult a = one.query(), b = two.query();
      ASSERT_EQ(answers(a), answers(b));
      ASSERT_EQ(a.any.size(), b.any.size());
      for (std::size_t i = 0; i < a.any.size(); ++i) ASSERT_EQ(a.any[i].pair, b.any[i].pair);
      ASSERT_EQ(a.flags.size(), b.flags.size());
      for (std::size_t i = 0; i < a.flags.size(); ++i) ASSERT_EQ(a.flags[i].flags, b.flags[i].flags);
      ASSERT_EQ(a.swept.size(), b.swept.size());
      for (std::size_t i = 0; i < a.swept.size(); ++i) ASSERT_EQ(a.swept[i].flags, b.swept[i].flags);
      ASSERT_EQ(a.first_contact.size(), b.first_contact.size());
      for (std::size_t i = 0; i < a.first_contact.size(); ++i)
        ASSERT_EQ(a.first_contact[i].fraction, b.first_contact[i].fraction);
      for (std::size_t e = 0; e < kEffects; ++e) {
        ASSERT_EQ(a.costs[e].work.node_pairs, b.costs[e].work.node_pairs) << nameOf(static_cast<Effect>(e));
        ASSERT_EQ(a.costs[e].work.exact_decisions, b.costs[e].work.exact_decisions);
      }
      world.shuffle({&one, &two});
    }
  }
}

TEST(Scene, AMovedObjectUpdatesOnlyTheVoxelsItLeavesAndEnters)
{
  Shelf shelf;
  const auto cube = shelf.add({{0, 0, 0}, {0.9, 0.9, 0.9}});
  SceneOptions options;
  options.effects.any = true;
  options.voxel_edge = 1.0;
  Scene scene(options);
  for (int i = 0; i < 100; ++i) scene.add(object("cube " + std::to_string(i), cube, at(2.0 * i + 0.05, 0.05, 0.05)));
  SceneResult result = scene.query();
  EXPECT_EQ(result.broad_phase.moved, 100u);
  EXPECT_EQ(result.broad_phase.voxels_entered, 100u);
  EXPECT_EQ(result.broad_phase.voxels_left, 0u);
  EXPECT_EQ(result.broad_phase.pairs_sharing, 0u);
  EXPECT_EQ(result.broad_phase.box_tests, 0u);

  scene.setPose(3, at(6.5, 0.05, 0.05)); // into one more voxel
  result = scene.query();
  EXPECT_EQ(result.broad_phase.moved, 1u);
  EXPECT_EQ(result.broad_phase.voxels_entered, 1u);
  EXPECT_EQ(result.broad_phase.voxels_left, 0u);

  scene.setPose(3, at(8.02, 0.05, 0.05)); // onto its neighbour
  result = scene.query();
  EXPECT_EQ(result.broad_phase.voxels_entered, 1u);
  EXPECT_EQ(result.broad_phase.voxels_left, 2u);
  EXPECT_EQ(result.broad_phase.pairs_sharing, 1u);
  EXPECT_EQ(result.broad_phase.box_tests, 1u);

  result = scene.query(); // nothing moved
  EXPECT_EQ(result.broad_phase.moved + result.broad_phase.voxels_entered + result.broad_phase.box_tests, 0u);
}

TEST(Scene, AnObjectLeavesTheVoxelsOfItsMotionWhenItRests)
{
  Shelf shelf;
  SceneOptions options;
  options.effects.first_contact = true;
  options.voxel_edge = 1.0;
  Scene scene(options);
  scene.add(object("cube", shelf.add({{0, 0, 0}, {0.9, 0.9, 0.9}}), at(0.05, 0.05, 0.05)));
  EXPECT_EQ(scene.query().broad_phase.voxels_entered, 1u);
  scene.setPose(0, at(3.05, 0.05, 0.05));
  const BroadPhaseCost moving = scene.query().broad_phase, resting = scene.query().broad_phase;
  EXPECT_EQ(moving.voxels_entered, 3u);
  EXPECT_EQ(moving.voxels_left, 0u);
  EXPECT_EQ(resting.moved, 1u);
  EXPECT_EQ(resting.voxels_left, 3u);
  EXPECT_EQ(resting.voxels_entered, 0u);
  EXPECT_EQ(scene.query().broad_phase.moved, 0u);
}

/// Progress of each query by itself, whichever effects it has.
TEST(Scene, ProgressGoesFromNothingToAll)
{
  for (std::size_t e = 0; e < 8; ++e) { // all that look, and each of them alone
    Shelf shelf;
    SceneOptions options;
    options.clearance = 1.5;
    options.effects.any = e == 0 || e == 1;
    options.effects.flags = e == 0 || e == 2;
    if (e == 0 || e == 3) options.effects.distance = 2.0;
    if (e == 0 || e == 4) options.effects.contacts = 2;
    options.effects.first_contact = e == 0 || e == 5;
    options.effects.swept = e == 0 || e == 6;
    options.effects.self = e == 0 || e == 7;
    double last = 0.0;
    std::size_t reports = 0;
    options.progress = [&](double done) {
      EXPECT_GE(done, last) << e;
      EXPECT_LE(done, 1.0) << e;
      last = done;
      ++reports;
      return true;
    };
    Scene scene(options);
    const auto points = shelf.add({{0, 0, 0}, {0.5, 0, 0}});
    for (int i = 0; i < 5; ++i) scene.add(object("object " + std::to_string(i), points, at(i, 0, 0)));
    for (int query = 0; query < 2; ++query) {
      last = 0.0;
      reports = 0;
      scene.query();
      EXPECT_EQ(last, 1.0) << e;
      EXPECT_GT(reports, e == 0 ? 6u : 0u) << e;
    }
  }
}

TEST(Scene, DeformationsAreCounted)
{
  Shelf shelf;
  SceneOptions options;
  options.effects.deform = 2.0;
  Scene scene(options);
  scene.add(object("one", shelf.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})));
  scene[0].parts[0].hierarchy->buildAll();
  const std::vector<Point3> moved = {{0, 0, 0.1}, {1, 0, 0}, {0, 1, 0}};
  const RefitReport report = scene.deform(0, 0, viewOf(moved[0].data(), 3));
  EXPECT_GT(report.volumes_refitted, 0u);
  const SceneResult result = scene.query();
  EXPECT_EQ(result.cost(Effect::deform).work.volumes_built, report.volumes_refitted);
  EXPECT_EQ(result.cost(Effect::deform).pairs, 1u);
  EXPECT_EQ(scene.query().cost(Effect::deform).pairs, 0u);
}

TEST(Scene, FindsWhatIsNearAcrossTheVoxelsBorders)
{
  Shelf shelf;
  const auto point = shelf.add({{0, 0, 0}});
  SceneOptions options;
  options.effects.any = true;
  options.effects.distance = 0.3;
  options.clearance = 0.25;
  options.voxel_edge = 0.5;
  Scene scene(options);
  scene.add(object("one", point));
  scene.add(object("other", point));
  Random random(11);
  for (int i = 0; i < 500; ++i) {
    const Point3 p = random.point([&] { return random.uniform(-1, 1); });
    const Point3 d = random.point([&] { return random.uniform(-0.25, 0.25); });
    scene.setPose(0, at(p[0], p[1], p[2]));
    scene.setPose(1, at(p[0] + d[0], p[1] + d[1], p[2] + d[2]));
    const SceneResult result = scene.query();
    const double apart = brute_force::closestPair(placed(scene, 0, 0), placed(scene, 1, 0)).distance;
    ASSERT_EQ(result.any.size(), apart <= 0.25 ? 1u : 0u) << i;
    ASSERT_EQ(result.distance.size(), apart <= 0.3 ? 1u : 0u) << i;
  }
}

TEST(Scene, WhatIsRememberedLastsNoLongerThanItHolds)
{
  Shelf shelf;
  const auto point = shelf.add({{0, 0, 0}}), bar = shelf.add({{-2, 0, 0}, {2, 0, 0}, {0, -2.1, 0}, {0, 2.1, 0}});
  SceneOptions options;
  options.effects.any = true;
  options.clearance = 0.1;
  for (const bool turning : {false, true}) {
    Scene scene(options);
    SceneObject mover = object("mover", turning ? bar : point, turning ? at(0, 0, 0) : at(-3, 0, 0));
    mover.motion = turning ? VelocityMotion{{0, 0, 0}, {0, 0, 0.5}} : VelocityMotion{{1, 0, 0}};
    scene.add(mover);
    scene.add(object("target", point, turning ? at(1.45, 1.45, 0) : at(0, 0.05, 0)));
    std::uint64_t reused = 0;
    int colliding = 0;
    for (int step = 0; step < 60; ++step) {
      const SceneResult result = scene.step(0.1);
      const AnyRequest request{options.clearance, {}};
      const bool expected =
          brute_force::anyCollision(placed(scene, 0, 0), placed(scene, 1, 0), request).pair.has_value();
      ASSERT_EQ(result.any.size(), expected ? 1u : 0u) << step;
      reused += result.cost(Effect::any).reused;
      colliding += expected;
    }
    EXPECT_GT(colliding, 0);
    EXPECT_TRUE(!turning || reused > 10) << reused; // boxes meet long before the points
  }
}

/// Two rows of cubes that touch pairwise, one row moving; made to be asked for any set of effects.
Scene busyScene(Shelf& shelf, const Effects& effects)
{
  SceneOptions options;
  options.effects = effects;
  options.clearance = 0.2;
  Scene scene(options);
  Random random(5);
  const auto cloud = shelf.add(test::makePoints(Shape::uniform, 200, 0.5, random));
  for (int i = 0; i < 6; ++i) {
    scene.add(fixedObject("wall " + std::to_string(i), cloud, at(2 * i, 0, 0)));
    SceneObject mover = object("mover " + std::to_string(i), cloud, at(2 * i, 1.1, 0));
    mover.parts.push_back({"arm", cloud, at(0, 0.2, 0)});
    mover.motion = VelocityMotion{{0, -0.1, 0}, {0, 0, 0.1}};
    scene.add(mover);
  }
  return scene;
}

Effects only(Effect effect)
{
  Effects effects;
  switch (effect) {
  case Effect::any:
    effects.any = true;
    break;
  case Effect::flags:
    effects.flags = true;
    break;
  case Effect::distance:
    effects.distance = 1.0;
    break;
  case Effect::contacts:
    effects.contacts = 4;
    break;
  case Effect::first_contact:
    effects.first_contact = true;
    break;
  case Effect::swept:
    effects.swept = true;
    break;
  case Effect::self:
    effects.self = true;
    break;
  case Effect::stop:
    effects.response = Response::stop;
    break;
  case Effect::slide:
    effects.response = Response::slide;
    break;
  case Effect::gravity:
    effects.gravity = Gravity{};
    break;
  case Effect::deform:
    effects.deform = 1.5;
    break;
  }
  return effects;
}

bool isZero(const EffectCost& cost)
{
  return cost.pairs == 0 && cost.reused == 0 && cost.seconds == 0.0 && cost.work.node_pairs == 0 &&
         cost.work.leaf_pairs == 0 && cost.work.exact_decisions == 0 && cost.work.voxels_built == 0;
}

TEST(Scene, AnEffectThatIsNotListedDoesNothing)
{
  for (std::size_t e = 0; e < kEffects; ++e) {
    const auto effect = static_cast<Effect>(e);
    SCOPED_TRACE(nameOf(effect));
    Shelf shelf;
    Scene scene = busyScene(shelf, only(effect));
    EXPECT_TRUE(only(effect).has(effect));
    EffectCost spent;
    for (int step = 0; step < 3; ++step) {
      const SceneResult result = scene.step(0.5);
      for (std::size_t other = 0; other < kEffects; ++other) {
        EXPECT_TRUE(other == e || isZero(result.costs[other])) << nameOf(static_cast<Effect>(other));
      }
      spent.pairs += result.costs[e].pairs;
      spent.seconds += result.costs[e].seconds;
      EXPECT_EQ(result.any.empty(), effect != Effect::any || result.any.empty());
      EXPECT_EQ(result.any.capacity() > 0, effect == Effect::any && !result.any.empty());
      EXPECT_EQ(result.flags.capacity() > 0, effect == Effect::flags && !result.flags.empty());
      EXPECT_EQ(result.distance.capacity() > 0, effect == Effect::distance && !result.distance.empty());
      EXPECT_EQ(result.contacts.capacity() > 0, effect == Effect::contacts && !result.contacts.empty());
      EXPECT_EQ(result.first_contact.capacity() > 0, effect == Effect::first_contact && !result.first_contact.empty());
      EXPECT_EQ(result.swept.capacity() > 0, effect == Effect::swept && !result.swept.empty());
      EXPECT_EQ(result.self.capacity() > 0, effect == Effect::self && !result.self.empty());
    }
    if (effect != Effect::deform) {
      EXPECT_GT(spent.pairs, 0u);
      EXPECT_GT(spent.seconds, 0.0);
    }
  }
}

TEST(Scene, AnEffectThatIsNotListedAllocatesAndBuildsNothing)
{
  Shelf shelf;
  Scene idle = busyScene(shelf, Effects());
  EXPECT_TRUE(Effects().none());
  const std::size_t before = test::allocations();
  for (int step = 0; step < 4; ++step) idle.step(0.5);
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(idle[0].parts[0].hierarchy->statistics().voxels_built, 0u);

  // A scene of one effect allocates as often, whatever the library could do besides: as often as its own queries, and
  // none of the others' results or tables.
  const auto allocationsOf = [&](const Effects& effects) {
    Shelf own;
    Scene scene = busyScene(own, effects);
    scene.step(0.5);
    scene.step(0.5);
    const std::size_t start = test::allocations();
    scene.query(); // nothing has moved: all answers are known
    return test::allocations() - start;
  };
  EXPECT_LE(allocationsOf(only(Effect::any)), 4u); // the list of colliding pairs grows
  EXPECT_EQ(allocationsOf(only(Effect::stop)), 0u);
  EXPECT_EQ(allocationsOf(only(Effect::gravity)), 0u);
  EXPECT_EQ(allocationsOf(only(Effect::deform)), 0u);
}

TEST(Scene, FixedObjectsMeetOnlyWhereARuleSaysSo)
{
  Shelf shelf;
  const auto point = shelf.add({{0, 0, 0}});
  SceneOptions options;
  options.effects.any = true;
  Scene scene(options);
  SceneObject left = fixedObject("left", point), right = fixedObject("right", point);
  left.group = right.group = "walls";
  const ObjectId a = scene.add(left), b = scene.add(right);
  EXPECT_TRUE(scene.query().any.empty());
  scene.setGroupRule("walls", "walls", {true, std::nullopt});
  EXPECT_EQ(scene.query().any.size(), 1u);
  scene.setRule(b, a, {false, std::nullopt});
  EXPECT_TRUE(scene.query().any.empty());
  scene.setRule(a, b, {true, 0.5});
  scene.setPose(b, at(0.5, 0, 0));
  EXPECT_EQ(scene.query().any.size(), 1u);
  scene.setPose(b, at(0.51, 0, 0));
  EXPECT_TRUE(scene.query().any.empty());
}

TEST(Scene, OnlyListedPairs)
{
  Shelf shelf;
  const auto point = shelf.add({{0, 0, 0}});
  SceneOptions options;
  options.effects.any = true;
  options.test_pairs = false;
  Scene scene(options);
  for (const char* name : {"a", "b", "c"}) scene.add(object(name, point));
  EXPECT_TRUE(scene.query().any.empty());
  scene.setRule(0, 2, {true, std::nullopt});
  const SceneResult result = scene.query();
  ASSERT_EQ(result.any.size(), 1u);
  EXPECT_EQ(result.any[0].a, 0u);
  EXPECT_EQ(result.any[0].b, 2u);
}

TEST(Scene, FirstContactWithAKnownAnswer)
{
  Shelf shelf;
  const auto point = shelf.add({{0, 0, 0}}), bar = shelf.add({{-1, 0, 0}, {1, 0, 0}});
  SceneOptions options;
  options.effects.first_contact = true;
  options.clearance = 0.5;
  options.tolerance = 1e-6;
  Scene scene(options);
  SceneObject bullet = object("bullet", point, at(-10, 0, 0));
  bullet.motion = VelocityMotion{{20, 0, 0}};
  scene.add(bullet);
  scene.add(object("target", point)); // passed right through
  EXPECT_TRUE(scene.query().first_contact.empty());
  SceneResult result = scene.step(1.0);
  ASSERT_EQ(result.first_contact.size(), 1u);
  EXPECT_NEAR(result.first_contact[0].fraction, 9.5 / 20, 1e-6);
  EXPECT_TRUE(scene.step(1.0).first_contact.empty());

  // A bar turning about its middle meets a point at (0, 1.2) when it has turned by an angle known from the triangle.
  Scene turning(options);
  SceneObject beam = object("beam", bar);
  beam.motion = VelocityMotion{{0, 0, 0}, {0, 0, 1}};
  turning.add(beam);
  turning.add(object("point", point, at(0, 1.2, 0)));
  turning.query();
  result = turning.step(1.5);
  ASSERT_EQ(result.first_contact.size(), 1u);
  // |(cos t, sin t) - (0, 1.2)|^2 = 1 + 1.44 - 2.4 sin t = 0.25
  EXPECT_NEAR(result.first_contact[0].fraction, std::asin(2.19 / 2.4) / 1.5, 1e-6);
}

TEST(Scene, FirstContactIsNeverLateAndSweptPointsAreAllFound)
{
  for (std::uint64_t seed = 300; seed < 316; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Shelf shelf;
    const auto shape = [&] { // without outliers, which go too far in a step of the check
      return test::all_shapes[static_cast<std::size_t>(random.integer(0, 6))];
    };
    const auto a = shelf.add(test::makePoints(shape(), 40, 1, random)),
               b = shelf.add(test::makePoints(shape(), 40, 1, random));
    SceneOptions options;
    options.effects.first_contact = options.effects.swept = true;
    options.clearance = random.uniform(0.05, 0.3);
    options.tolerance = 1e-4;
    Scene scene(options);
    const Eigen::Isometry3d start = random.pose(4), goal = random.pose(4);
    SceneObject moving = object("moving", a, start);
    const bool turning = random.chance(0.7);
    Eigen::Isometry3d end = goal;
    if (!turning) end.linear() = start.linear();
    moving.motion = WaypointMotion{{0, 1}, {start, end}};
    scene.add(moving);
    scene.add(object("other", b, random.pose(1)));
    scene.query();
    const SceneResult result = scene.step(1);

    // This motion in small steps. Turning about the box's centre and about the origin differ: use the box's centre.
    Eigen::Vector3d low = Eigen::Vector3d::Constant(infinity), high = -low;
    for (std::size_t i = 0; i < 40; ++i) {
      const Point3 p = a->view().point(static_cast<std::uint32_t>(i));
      low = low.cwiseMin(Eigen::Vector3d(p[0], p[1], p[2]));
      high = high.cwiseMax(Eigen::Vector3d(p[0], p[1], p[2]));
    }
    const Eigen::Vector3d center = 0.5 * (low + high);
    double first = infinity, nearest_at_contact = infinity;
    std::vector<Verdict> swept(40, Verdict::free), maybe(40, Verdict::free);
    const auto poseOf = [&](double s) {
      Eigen::Isometry3d pose = start;
      const Eigen::Quaterniond q(start.linear()), r(end.linear());
      pose.linear() = q.slerp(s, r).toRotationMatrix();
      pose.translation() = (1 - s) * (start * center) + s * (end * center) - pose.linear() * center;
      return pose;
    };
    const Eigen::Isometry3d other = scene.worldPose(1);
    constexpr int steps = 200;
    for (int i = 0; i <= steps; ++i) {
      const double s = static_cast<double>(i) / steps;
      const FlagsResult flags = brute_force::collisionFlags({*a, poseOf(s)}, {*b, other}, within(options.clearance));
      if (flags.colliding_a > 0) first = std::min(first, s);
      const FlagsResult wide =
          brute_force::collisionFlags({*a, poseOf(s)}, {*b, other}, within(options.clearance + 0.1));
      for (std::size_t k = 0; k < 40; ++k) {
        swept[k] = graver(swept[k], flags.a[k]);
        maybe[k] = graver(maybe[k], wide.a[k]);
      }
    }
    const double fraction = result.first_contact.empty() ? infinity : result.first_contact[0].fraction;
    EXPECT_LE(fraction, first);
    if (fraction <= 1) {
      nearest_at_contact = brute_force::closestPair({*a, poseOf(fraction)}, {*b, other}).distance;
      EXPECT_LE(nearest_at_contact, options.clearance + options.tolerance + 1e-9);
    }
    const auto flagged = std::find_if(result.swept.begin(), result.swept.end(),
                                      [](const FlaggedPart& part) { return part.object == 0; });
    for (std::size_t k = 0; k < 40; ++k) {
      const bool is = flagged != result.swept.end() && flagged->flags[k] == Verdict::colliding;
      EXPECT_TRUE(is || swept[k] == Verdict::free) << k;
      EXPECT_TRUE(!is || maybe[k] == Verdict::colliding) << k;
    }
    EXPECT_EQ(flagged == result.swept.end(), result.first_contact.empty());
  }
}

/// Boxes of hierarchies are in units of their own where lengths are beyond what a float holds; and a pair at just the
/// greatest distance is one.
TEST(Scene, KnowsWhatIsNearAtAnyMagnitude)
{
  for (const double scale : {0x1p-300, 1.0, 0x1p300}) {
    Shelf shelf;
    SceneOptions options;
    options.clearance = 0.5 * scale;
    options.effects.any = options.effects.flags = true;
    options.effects.distance = 0.5 * scale;
    Scene scene(options);
    for (const double from : {0.0, 7.5}) {
      std::vector<Point3> row;
      for (int i = 0; i < 8; ++i) row.push_back({(from + i) * scale, 0.25 * scale, 0.25 * scale});
      scene.add(object(from == 0.0 ? "one" : "next", shelf.add(row)));
    }
    const SceneResult found = scene.query();
    EXPECT_EQ(found.any.size(), 1u) << scale;
    EXPECT_EQ(found.flags.size(), 2u) << scale;
    ASSERT_EQ(found.distance.size(), 1u) << scale;
    EXPECT_EQ(found.distance[0].distance, 0.5 * scale);
  }
}

/// So far that its speed is no number: nothing is looked up ahead of it.
TEST(Scene, KnowsWhatIsNearAfterAnyMotion)
{
  Shelf shelf;
  SceneOptions options;
  options.clearance = 0.5;
  options.effects.any = true;
  Scene scene(options);
  const double farthest = std::numeric_limits<double>::max();
  const ObjectId mover = scene.add(object("mover", shelf.add({{0, 0, 0}}), at(farthest, 0, 0)));
  scene.add(object("other", shelf.add({{0, 0, 0}})));
  EXPECT_TRUE(scene.query().any.empty());
  for (const auto& [x, collides] : {std::pair(-farthest, false), {0.25, true}, {farthest, false}, {0.75, false}}) {
    scene.setPose(mover, at(x, 0, 0));
    EXPECT_EQ(scene.query().any.size(), collides ? 1u : 0u) << x;
  }
}

TEST(Scene, OfObjectsWithoutAPointFindsNothing)
{
  Shelf shelf;
  SceneOptions options;
  options.effects.any = options.effects.flags = options.effects.first_contact = options.effects.swept = true;
  options.effects.distance = 1.0;
  Scene scene(options);
  const auto nothing = shelf.add(std::vector<Point3>());
  scene.add(object("one", nothing));
  SceneObject other = object("other", nothing);
  other.motion = VelocityMotion{{1, 0, 0}, {0, 0, 1}};
  scene.add(other);
  const SceneResult result = scene.step(1.0);
  EXPECT_TRUE(result.any.empty() && result.flags.empty() && result.distance.empty());
  EXPECT_TRUE(result.first_contact.empty() && result.swept.empty());
}

TEST(Scene, ContactsThatAreLeftOutAreTold)
{
  Shelf shelf;
  SceneOptions options;
  options.clearance = 0.5;
  for (const auto& [most, complete] : {std::pair(std::size_t{0}, false), {1, false}, {2, true}}) {
    options.effects.contacts = most;
    Scene scene(options);
    scene.add(object("one", shelf.add({{0, 0, 0}, {0.25, 0, 0}})));
    scene.add(object("other", shelf.add({{0, 0, 0}}), at(0, 0.125, 0)));
    const SceneResult result = scene.query();
    ASSERT_EQ(result.contacts.size(), 1u) << most;
    EXPECT_EQ(result.contacts[0].contacts.size(), most);
    EXPECT_EQ(result.contacts[0].complete, complete) << most;
    scene.setPose(1, at(0, 9, 0));
    EXPECT_TRUE(scene.query().contacts.empty());
  }
}

TEST(Scene, SaysWhichOptionMakesNoSense)
{
  const auto refusal = [](const auto& change) {
    SceneOptions options;
    options.effects.gravity = Gravity{};
    options.effects.deform = 1.0;
    change(options);
    return refusalOf([&] { Scene{options}; });
  };
  EXPECT_EQ(refusal([](SceneOptions&) {}), "");
  for (const double wrong : {-1.0, infinity, std::nan("")}) {
    SCOPED_TRACE(wrong);
    EXPECT_THAT(refusal([&](SceneOptions& o) { o.clearance = wrong; }), HasSubstr("is not finite and >= 0"));
    EXPECT_THAT(refusal([&](SceneOptions& o) { o.tolerance = wrong; }), HasSubstr("is not finite and > 0"));
    EXPECT_THAT(refusal([&](SceneOptions& o) { o.accuracy = Accuracy::tolerance(wrong); }),
                AllOf(HasSubstr("accuracy tolerance="), HasSubstr("has a number that is not finite and >= 0")));
    EXPECT_THAT(refusal([&](SceneOptions& o) { o.voxel_edge = wrong; }),
                AllOf(HasSubstr("voxel edge "), HasSubstr("is not finite and >= 0")));
    EXPECT_THAT(refusal([&](SceneOptions& o) { o.effects.gravity->step_height = wrong; }),
                AllOf(HasSubstr("step height "), HasSubstr("is not finite and > 0")));
    EXPECT_THAT(refusal([&](SceneOptions& o) { o.effects.deform = wrong; }),
                AllOf(HasSubstr("deform's threshold "), HasSubstr("is not finite and >= 1")));
  }
  EXPECT_THAT(refusal([](SceneOptions& o) { o.effects.gravity->step_height = 0.0; }), HasSubstr("step height 0"));
  for (const Eigen::Vector3d& down : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, infinity)})
    EXPECT_THAT(refusal([&](SceneOptions& o) { o.effects.gravity->down = down; }),
                HasSubstr("gravity's direction is not finite or of length 0"));
  EXPECT_THAT(refusal([](SceneOptions& o) { o.effects.distance = -1.0; }), HasSubstr("distances within -1"));
  EXPECT_EQ(refusal([](SceneOptions& o) { o.effects.distance = o.clearance = o.voxel_edge = 0.0; }), "");
}

TEST(Scene, SaysWhichObjectRuleOrPartMakesNoSense)
{
  Shelf shelf;
  Scene scene({});
  const std::vector<Point3> place = {{0, 0, 0}};
  scene.add(object("one", shelf.add(place)));
  scene.add(object("two", shelf.add(place)));
  for (const double wrong : {-1.0, infinity}) {
    EXPECT_THAT(refusalOf([&] { scene.setRule(0, 1, {{}, wrong}); }), HasSubstr("of a rule is not finite and >= 0"));
    EXPECT_THAT(refusalOf([&] { scene.setGroupRule("", "", {{}, wrong}); }), HasSubstr("of a rule is not finite"));
  }
  for (const std::pair<std::uint32_t, std::uint32_t>& joint : {std::pair(0u, 1u), {1u, 0u}}) {
    SceneObject joined = object("joined", shelf.add(place));
    joined.adjacent = {joint};
    EXPECT_THAT(refusalOf([&] { scene.add(joined); }),
                HasSubstr("object 'joined': part 1 is adjacent, but there are 1 parts"));
  }
  const PointsView view = viewOf(place[0].data(), 1);
  EXPECT_EQ(refusalOf([&] { scene.deform(0, 0, view); }), "Scene: object 'one' cannot deform: deform is not listed");
  SceneOptions options;
  options.effects.deform = 1.5;
  Scene deforming(options);
  deforming.add(object("one", shelf.add(place)));
  EXPECT_EQ(refusalOf([&] { deforming.deform(0, 0, view); }), "");
  EXPECT_THAT(refusalOf([&] { deforming.deform(0, 1, view); }), HasSubstr("object 'one' has no part 1"));
}

TEST(Scene, RefusesWhatMakesNoSense)
{
  Shelf shelf;
  const auto point = shelf.add({{0, 0, 0}});
  SceneOptions options;
  options.clearance = -1;
  EXPECT_THROW(Scene{options}, std::invalid_argument);
  options = {};
  options.tolerance = 0;
  EXPECT_THROW(Scene{options}, std::invalid_argument);
  options = {};
  options.effects.gravity = Gravity{-1, {0, 0, -1}};
  EXPECT_THROW(Scene{options}, std::invalid_argument);
  options = {};
  options.effects.deform = 0.5;
  EXPECT_THROW(Scene{options}, std::invalid_argument);
  options = {};
  options.effects.distance = std::nan("");
  EXPECT_THROW(Scene{options}, std::invalid_argument);

  Scene scene({});
  EXPECT_THROW(scene.add(object("", point)), std::invalid_argument);
  EXPECT_THROW(scene.add(object("nothing", nullptr)), std::invalid_argument);
  EXPECT_THROW(scene.add(SceneObject{"no parts", "", {}, identity, false, {}, {}}), std::invalid_argument);
  scene.add(object("one", point));
  EXPECT_THROW(scene.add(object("one", point)), std::invalid_argument);
  Eigen::Isometry3d scaled = identity;
  scaled.linear() *= 2;
  EXPECT_THROW(scene.add(object("scaled", point, scaled)), std::invalid_argument);
  EXPECT_THROW(scene.setPose(0, scaled), std::invalid_argument);
  EXPECT_THROW(scene.setPose(7, identity), std::invalid_argument);
  EXPECT_THROW(scene.pointsChanged(7), std::invalid_argument);
  EXPECT_THROW(scene.setMotion(0, CircularMotion{{0, 0, 0}, {0, 0, 0}, 1, true}), std::invalid_argument);
  EXPECT_THROW(scene.setMotion(0, WaypointMotion{{1, 1}, {identity, identity}}), std::invalid_argument);
  EXPECT_THROW(scene.step(-1), std::invalid_argument);
  EXPECT_THROW(scene.step(std::nan("")), std::invalid_argument);
  EXPECT_THROW(scene.setRule(0, 0, {true, std::nullopt}), std::invalid_argument);
  SceneObject joined = object("joined", point);
  joined.adjacent = {{0, 1}};
  EXPECT_THROW(scene.add(joined), std::invalid_argument);
  EXPECT_EQ(scene.size(), 1u);
  EXPECT_EQ(scene.find("one"), ObjectId{0});
  EXPECT_EQ(scene.find("two"), std::nullopt);
}

} // namespace
} // namespace pcl_bsh
