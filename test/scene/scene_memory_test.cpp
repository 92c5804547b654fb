// SPDX-License-Identifier: BSD-3-Clause
// Memory of a scene, whatever happens between its queries, with every combination of effects.
#include <pcl_bsh/hierarchy/update.h>
#include <pcl_bsh/scene/scene.h>

#include "random_world.h"
#include "support/verdicts.h"
#include "watched_motion.h"

#include <gtest/gtest.h>

#include <optional>

namespace pcl_bsh {
namespace {

using test::at;
using test::Cloud;
using test::Layout;
using test::Random;
using test::RandomWorld;
using test::Shape;
using test::Shelf;
using test::WatchedMotion;

constexpr std::size_t kLooking = 6; ///< effects that only look and may be listed in any combination
constexpr Effect looking[kLooking] = {Effect::any,      Effect::flags,         Effect::distance,
                                      Effect::contacts, Effect::first_contact, Effect::swept};

Effects listed(unsigned bits, Response response = Response::none)
{
  Effects effects;
  effects.response = response;
  effects.any = bits & 1;
  effects.flags = bits & 2;
  if (bits & 4) effects.distance = 0.4;
  if (bits & 8) effects.contacts = 3;
  effects.first_contact = bits & 16;
  effects.swept = bits & 32;
  effects.self = bits & 64;
  return effects;
}

/// One effect's answer as text; of `any`, whose witness may be any pair of points that collides, the objects alone.
std::string answerOf(const SceneResult& result, Effect effect)
{
  std::string text;
  const auto add = [&text](double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g ", value);
    text += digits;
  };
  const auto objects = [&](const PartPair& pair) {
    text += std::to_string(pair.a) + "x" + std::to_string(pair.b) + " ";
  };
  const auto parts = [&](const PartPair& pair) {
    objects(pair);
    text += std::to_string(pair.part_a) + "," + std::to_string(pair.part_b) + " ";
  };
  const auto points = [&](PointPair pair) { text += std::to_string(pair.a) + ":" + std::to_string(pair.b) + " "; };
  const auto flags = [&](const std::vector<FlaggedPart>& list) {
    for (const FlaggedPart& part : list) {
      text += std::to_string(part.object) + "." + std::to_string(part.part) + " ";
      for (const Verdict flag : part.flags) text += static_cast<char>('0' + test::numberOf(flag));
    }
  };
  if (effect == Effect::any)
    for (const CollidingPair& pair : result.any) objects(pair);
  if (effect == Effect::flags) flags(result.flags);
  if (effect == Effect::distance)
    for (const DistantPair& pair : result.distance) {
      parts(pair);
      points(pair.pair);
      add(pair.distance);
    }
  if (effect == Effect::contacts)
    for (const ContactPair& pair : result.contacts) {
      parts(pair);
      text += pair.complete ? "all " : "some ";
      for (const Contact& contact : pair.contacts) points(contact.pair);
    }
  if (effect == Effect::first_contact)
    for (const PartFirstContact& pair : result.first_contact) {
      parts(pair);
      points(pair.pair);
      add(pair.fraction);
    }
  if (effect == Effect::swept) flags(result.swept);
  return text;
}

TEST(SceneCombinations, EachEffectAnswersAsIfItWereAlone)
{
  for (std::uint64_t seed = 700; seed < 703; ++seed) {
    RandomWorld world(seed);
    std::vector<Scene> alone, together;
    for (std::size_t e = 0; e < kLooking; ++e) alone.push_back(world.scene(listed(1u << e), 1, false));
    const unsigned threads[] = {1, 2, 4};
    for (unsigned bits = 0; bits < 128; ++bits) {
      const auto way = static_cast<unsigned>(seed) + bits;
      together.push_back(world.scene(listed(bits), threads[way % 3], way % 2 == 0));
    }
    std::vector<Scene*> all;
    for (Scene& scene : alone) all.push_back(&scene);
    for (Scene& scene : together) all.push_back(&scene);
    for (int step = 0; step < 3; ++step) {
      std::vector<std::string> expected;
      for (std::size_t e = 0; e < kLooking; ++e) {
        const SceneResult result = alone[e].query();
        if (looking[e] == Effect::first_contact) {
          WatchedMotion watch(alone[e], [&](ObjectId a, ObjectId b) { return world.clearanceOf(a, b); });
          ASSERT_EQ(watch.replayFirstContacts(result, 200), "") << "seed " << seed << ", step " << step;
        }
        expected.push_back(answerOf(result, looking[e]));
        if (looking[e] == Effect::any) expectAnyAsBruteForce(world, alone[e], result);
        if (looking[e] == Effect::flags) expectFlagsAsBruteForce(world, alone[e], result);
        if (looking[e] == Effect::distance) expectDistancesAsBruteForce(world, alone[e], result, 0.4);
        if (looking[e] == Effect::contacts) expectContactsAsQueried(world, alone[e], result, 3);
      }
      for (unsigned bits = 0; bits < 128; ++bits) {
        const SceneResult result = together[bits].query();
        for (unsigned e = 0; e < kLooking; ++e)
          ASSERT_EQ(answerOf(result, looking[e]), bits >> e & 1 ? expected[e] : "")
              << "seed " << seed << ", step " << step << ", effects " << bits << ", " << nameOf(looking[e]);
      }
      world.shuffle(all);
    }
  }
}

TEST(SceneCombinations, ResponsesGoTheSameWayWhateverElseIsListed)
{
  for (std::uint64_t seed = 3000; seed < 3004; ++seed)
    for (const Response response : {Response::stop, Response::slide}) {
      RandomWorld world(seed);
      std::vector<Scene> scenes;
      for (unsigned bits = 0; bits < 64; bits += seed % 2 == 0 ? 1 : 3)
        scenes.push_back(world.scene(listed(bits, response), bits % 2 + 1, bits % 4 < 2));
      std::vector<Scene> alone; // put where the responses lead
      for (std::size_t e = 0; e < kLooking; ++e) {
        alone.push_back(world.scene(listed(1u << e), 1, false));
        alone.back().query();
      }
      Random random(seed);
      for (ObjectId id = 0; id < scenes.front().size(); ++id) {
        const Point3 v = random.point([&] { return random.uniform(-1, 1); });
        const Point3 w = random.point([&] { return random.uniform(-1, 1); });
        if (scenes.front()[id].fixed) continue;
        for (Scene& scene : scenes) scene.setMotion(id, VelocityMotion{{v[0], v[1], v[2]}, {w[0], w[1], w[2]}});
      }
      for (Scene& scene : scenes) scene.query();
      for (int step = 0; step < 3; ++step) {
        std::vector<std::optional<std::string>> expected(kLooking);
        const auto clearanceOf = [&](ObjectId a, ObjectId b) { return world.clearanceOf(a, b); };
        WatchedMotion watch(scenes.front(), clearanceOf);
        for (std::size_t i = 0; i < scenes.size(); ++i) {
          const SceneResult result = scenes[i].step(0.4);
          const Effects& effects = scenes[i].options().effects;
          if (i == 0) {
            ASSERT_EQ(watch.replayResponses(result, 300), "") << "seed " << seed << ", step " << step;
          }
          for (ObjectId id = 0; id < scenes[i].size(); ++id)
            ASSERT_EQ(scenes[i][id].pose.matrix(), scenes.front()[id].pose.matrix()) << "seed " << seed << ", " << i;
          if (i == 0)
            for (std::size_t e = 0; e < kLooking; ++e) {
              for (ObjectId id = 0; id < scenes[i].size(); ++id) alone[e].setPose(id, scenes.front()[id].pose);
              // There the motion is another one: a pair that a response halts at the tolerance may be within it or not.
              const std::string answer = answerOf(alone[e].query(), looking[e]);
              if (looking[e] != Effect::first_contact && looking[e] != Effect::swept) expected[e] = answer;
            }
          for (std::size_t e = 0; e < kLooking; ++e) {
            const bool is_listed = effects.has(looking[e]);
            const std::string answer = answerOf(result, looking[e]);
            if (is_listed && !expected[e]) {
              expected[e] = answer;
              if (looking[e] == Effect::first_contact) {
                ASSERT_EQ(WatchedMotion(scenes[i], clearanceOf).replayFirstContacts(result, 10), "") << "seed " << seed;
              }
            }
            ASSERT_EQ(answer, is_listed ? *expected[e] : "")
                << "seed " << seed << ", step " << step << ", scene " << i << ", " << nameOf(looking[e]);
          }
        }
      }
    }
}

TEST(SceneCombinations, MemoryAndThreadsChangeNothingAtAnyAccuracy)
{
  for (std::uint64_t seed = 740; seed < 742; ++seed)
    for (const char* setting : {"level=1", "pairs=50", "tolerance=0.05"}) {
      RandomWorld world(seed);
      std::vector<Scene> scenes;
      for (const unsigned threads : {1u, 2u, 4u})
        for (const bool remember : {false, true})
          scenes.push_back(world.scene(listed(127), threads, remember, Accuracy::parse(setting)));
      std::vector<Scene*> all;
      for (Scene& scene : scenes) all.push_back(&scene);
      for (int step = 0; step < 3; ++step) {
        const SceneResult expected = scenes.front().query();
        for (std::size_t i = 1; i < scenes.size(); ++i) {
          const SceneResult result = scenes[i].query();
          for (const Effect effect : looking)
            ASSERT_EQ(answerOf(result, effect), answerOf(expected, effect))
                << "seed " << seed << " at " << setting << ", scene " << i << ", " << nameOf(effect);
          ASSERT_EQ(result.undecided.size(), expected.undecided.size());
          ASSERT_EQ(result.self.size(), expected.self.size());
        }
        world.shuffle(all);
      }
    }
}

// --- memory ---

SceneOptions remembering()
{
  SceneOptions options;
  options.effects = listed(127);
  options.effects.deform = 1.5;
  options.clearance = 0.1;
  return options;
}

std::vector<Point3> row(double y)
{
  return {{0, y, 0}, {1, y, 0}, {2, y, 0}};
}

TEST(SceneMemory, PointsThatAnotherSceneDeformsAreNotBelieved)
{
  const Layout layout{Scalar::float64, 0, 0};
  const Cloud near(row(0), layout), far_away(row(5), layout);
  const auto soft = std::make_shared<SphereHierarchy>(near.view());
  Shelf shelf;
  const auto probe = shelf.add({{1, 0.05, 0}});
  Scene one(remembering()), two(remembering());
  for (Scene* scene : {&one, &two}) {
    scene->add(object("soft", soft));
    scene->add(object("probe", probe));
  }
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(one.query().any.size(), 1u);
    EXPECT_EQ(two.query().any.size(), 1u);
    one.deform(0, 0, far_away.view());
    for (Scene* scene : {&two, &one}) {
      const SceneResult result = scene->query();
      for (const Effect effect : looking) EXPECT_EQ(answerOf(result, effect), "") << nameOf(effect);
    }
    two.deform(0, 0, near.view());
    for (Scene* scene : {&one, &two}) {
      const SceneResult result = scene->query();
      EXPECT_EQ(result.any.size(), 1u);
      EXPECT_EQ(result.flags.size(), 2u);
      EXPECT_EQ(result.distance.size(), 1u);
      EXPECT_EQ(result.contacts.size(), 1u);
    }
  }
}

TEST(SceneMemory, PointsThatACallerUpdatesAreNotBelieved)
{
  std::vector<double> records = {0, 0, 0, 1, 0, 0, 2, 0, 0};
  PointsView view;
  view.data = records.data();
  view.count = 3;
  view.stride = 3 * sizeof(double);
  view.offset = {0, sizeof(double), 2 * sizeof(double)};
  view.scalar = Scalar::float64;
  const auto updated = std::make_shared<SphereHierarchy>(view);
  Shelf shelf;
  Scene scene(remembering());
  scene.add(object("updated", updated));
  scene.add(object("probe", shelf.add({{1, 5, 0}})));
  EXPECT_TRUE(scene.query().any.empty());
  for (const double y : {5.0, 0.0, 5.05}) {
    const std::int32_t changed[] = {1};
    HierarchyUpdate update(*updated, changed, 1);
    records[4] = y;
    update.commit(view);
    EXPECT_EQ(scene.query().any.size(), y > 1 ? 1u : 0u) << y;
    EXPECT_EQ(scene.query().any.size(), y > 1 ? 1u : 0u) << y;
  }
  const Cloud other(row(4.98), {Scalar::float64, 0, 0});
  *updated = SphereHierarchy(other.view()); // another cloud in its place
  EXPECT_EQ(scene.query().any.size(), 1u);
  const Cloud gone(row(9), {Scalar::float64, 0, 0});
  *updated = SphereHierarchy(gone.view());
  EXPECT_TRUE(scene.query().any.empty());
}

TEST(SceneMemory, HoldsThroughAnyOrderOfChanges)
{
  std::uint64_t reused = 0;
  for (std::uint64_t seed = 760; seed < 768; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Shelf shelf;
    std::deque<Cloud> shapes;
    std::vector<std::shared_ptr<SphereHierarchy>> clouds;
    for (int i = 0; i < 3; ++i) {
      shapes.emplace_back(test::makePoints(Shape::uniform, 30, 0.5, random), Layout{Scalar::float64, 0, 0});
      clouds.push_back(std::make_shared<SphereHierarchy>(shapes.back().view()));
    }
    const auto made = [](bool remember) {
      SceneOptions options = remembering();
      options.effects.first_contact = options.effects.swept = false; // a scene made anew has no past
      options.remember = remember;
      return Scene(options);
    };
    Scene scene = made(true);
    std::vector<std::tuple<ObjectId, ObjectId, PairRule>> rules;
    const auto add = [&] {
      SceneObject object;
      object.name = "object " + std::to_string(scene.size());
      object.pose = random.pose(1.5);
      for (int p = random.integer(0, 1); p >= 0; --p)
        object.parts.push_back({"part", clouds[static_cast<std::size_t>(random.integer(0, 2))], random.pose(0.3)});
      object.fixed = random.chance(0.2);
      scene.add(object);
    };
    for (int i = 0; i < 5; ++i) add();
    for (int change = 0; change < 60; ++change) {
      const auto id = static_cast<ObjectId>(random.integer(0, static_cast<int>(scene.size()) - 1));
      Eigen::Isometry3d pose = random.chance(0.5) ? random.pose(1.5) : scene[id].pose;
      pose.translation().x() += random.uniform(-0.05, 0.05);
      double dt = 0.0;
      switch (random.integer(0, 8)) {
      case 0:
        scene.setPose(id, pose);
        break;
      case 1:
        scene.setPose(id, scene[id].pose); // the same again
        break;
      case 2:
        scene.setPartPose(id, 0, random.pose(0.3));
        break;
      case 3:
        if (scene.size() < 9) add();
        break;
      case 4: {
        const auto other = static_cast<ObjectId>(random.integer(0, static_cast<int>(scene.size()) - 1));
        if (other == id) break;
        PairRule rule;
        if (random.chance(0.5)) rule.tested = random.chance(0.7);
        if (random.chance(0.5)) rule.clearance = random.uniform(0, 0.4);
        scene.setRule(id, other, rule);
        rules.emplace_back(id, other, rule);
        break;
      }
      case 5: {
        shapes.emplace_back(test::makePoints(Shape::uniform, 30, random.uniform(0.3, 0.7), random),
                            Layout{Scalar::float64, 0, 0});
        if (random.chance(0.5))
          scene.deform(id, 0, shapes.back().view());
        else
          clouds[static_cast<std::size_t>(random.integer(0, 2))]->refit(shapes.back().view()); // behind its back
        break;
      }
      case 6:
        scene.setMotion(id, VelocityMotion{{random.uniform(-1, 1), 0, 0}, {0, random.uniform(-3, 3), 0}});
        break;
      default:
        dt = random.uniform(0, 0.1);
      }
      const SceneResult result = dt > 0.0 ? scene.step(dt) : scene.query();
      Scene anew = made(false);
      for (ObjectId i = 0; i < scene.size(); ++i) anew.add(scene[i]);
      for (const auto& [a, b, rule] : rules) anew.setRule(a, b, rule);
      const SceneResult expected = anew.query();
      for (const Effect effect : looking)
        ASSERT_EQ(answerOf(result, effect), answerOf(expected, effect))
            << "change " << change << ", " << nameOf(effect);
      ASSERT_EQ(result.self.size(), expected.self.size());
      reused += result.cost(Effect::any).reused;
    }
  }
  EXPECT_GT(reused, 500u);
}

} // namespace
} // namespace pcl_bsh
