// SPDX-License-Identifier: BSD-3-Clause
// Random scenes, and their answers by brute force over all objects.
#pragma once

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/scene/scene.h>

#include "scene_worlds.h"
#include "support/question.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace pcl_bsh::test {

/// A scene of random objects, some of several parts, some fixed, some in groups, and its rules.
class RandomWorld {
public:
  /// @param uncertain whether points may be elsewhere than they were measured
  explicit RandomWorld(std::uint64_t seed, bool uncertain = false) : random_(seed)
  {
    const int clouds = random_.integer(2, 5);
    for (int i = 0; i < clouds; ++i) {
      const auto count = static_cast<std::size_t>(random_.integer(i == 0 ? 0 : 1, 60));
      Cloud cloud = anyCloud(count, random_.uniform(0.3, 1.5), {0, 0, 0}, random_);
      if (uncertain && random_.chance(0.7)) makeUncertain(cloud, 0.15, random_);
      hierarchies_.push_back(shelf_.add(std::move(cloud)));
    }
    const int objects = random_.integer(2, 14);
    for (int i = 0; i < objects; ++i) {
      SceneObject object;
      object.name = "object " + std::to_string(i);
      object.group = random_.chance(0.3) ? "some" : "";
      object.fixed = random_.chance(0.3);
      object.pose = random_.pose(3.0);
      const int parts = random_.chance(0.3) ? 3 : 1;
      for (int p = 0; p < parts; ++p)
        object.parts.push_back({"part", hierarchies_[static_cast<std::size_t>(random_.integer(0, clouds - 1))],
                                parts == 1 ? Eigen::Isometry3d::Identity() : random_.pose(0.5)});
      if (parts == 3) object.adjacent.emplace_back(1, 0);
      objects_.push_back(object);
    }
    clearance_ = random_.uniform(0, 0.3);
    for (int i = 0; i < objects / 3; ++i) {
      const auto any = [&] { return static_cast<ObjectId>(random_.integer(0, objects - 1)); };
      PairRule rule;
      if (random_.chance(0.5)) rule.tested = random_.chance(0.5);
      if (random_.chance(0.5)) rule.clearance = random_.uniform(0, 0.6);
      const ObjectId a = any(), b = any();
      if (a != b) rules_.push_back({a, b, rule});
    }
    if (random_.chance(0.5)) group_rule_.tested = random_.chance(0.5);
    test_pairs_ = random_.chance(0.8);
  }

  pcl_bsh::Scene scene(const Effects& effects, unsigned threads = 1, bool remember = true,
                       const Accuracy& accuracy = {}) const
  {
    SceneOptions options;
    options.effects = effects;
    options.clearance = clearance_;
    options.test_pairs = test_pairs_;
    options.threads = threads;
    options.remember = remember;
    options.accuracy = accuracy;
    pcl_bsh::Scene scene(options);
    for (const SceneObject& object : objects_) scene.add(object);
    scene.setGroupRule("some", "some", group_rule_);
    for (const auto& [a, b, rule] : rules_) scene.setRule(a, b, rule);
    return scene;
  }

  /// The rules in another form: the clearance of a pair that is tested.
  std::optional<double> clearanceOf(ObjectId a, ObjectId b) const
  {
    bool tested = test_pairs_ && !(objects_[a].fixed && objects_[b].fixed);
    double clearance = clearance_;
    const auto apply = [&](const PairRule& rule) {
      tested = rule.tested.value_or(tested);
      clearance = rule.clearance.value_or(clearance);
    };
    if (objects_[a].group == "some" && objects_[b].group == "some") apply(group_rule_);
    for (const auto& [c, d, rule] : rules_)
      if ((a == c && b == d) || (a == d && b == c)) apply(rule);
    return tested ? std::optional(clearance) : std::nullopt;
  }

  /// Moves some objects, the same way in every scene.
  void shuffle(std::vector<pcl_bsh::Scene*> scenes)
  {
    for (ObjectId i = 0; i < objects_.size(); ++i) {
      if (random_.chance(0.5)) continue;
      Eigen::Isometry3d pose = (*scenes.front())[i].pose;
      const Eigen::Isometry3d turn = random_.pose(0.0);
      const double reach = random_.chance(0.2) ? 3.0 : 0.05;
      if (random_.chance(0.3)) pose.linear() = turn.linear() * pose.linear();
      const Point3 shift = random_.point([&] { return random_.uniform(-reach, reach); });
      pose.translation() += Eigen::Vector3d(shift[0], shift[1], shift[2]);
      for (pcl_bsh::Scene* scene : scenes) scene->setPose(i, pose);
    }
  }

private:
  struct Rule {
    ObjectId a, b;
    PairRule rule;
  };

  Random random_;
  Shelf shelf_;
  std::vector<std::shared_ptr<SphereHierarchy>> hierarchies_;
  std::vector<SceneObject> objects_;
  double clearance_ = 0.0;
  bool test_pairs_ = true;
  std::vector<Rule> rules_;
  PairRule group_rule_;
};

inline Placed placed(const pcl_bsh::Scene& scene, ObjectId object, std::uint32_t part)
{
  return {*scene[object].parts[part].hierarchy, scene.worldPose(object, part)};
}

/// Calls visit(a, b, part_a, part_b, clearance) for all pairs of parts of pairs to be tested.
template <class Visit>
void eachPartPair(const RandomWorld& world, const pcl_bsh::Scene& scene, const Visit& visit)
{
  for (ObjectId a = 0; a < scene.size(); ++a)
    for (ObjectId b = a + 1; b < scene.size(); ++b)
      if (const auto clearance = world.clearanceOf(a, b))
        for (std::uint32_t i = 0; i < scene[a].parts.size(); ++i)
          for (std::uint32_t j = 0; j < scene[b].parts.size(); ++j) visit(a, b, i, j, *clearance);
}

inline Question within(double clearance)
{
  Question request;
  request.clearance = clearance;
  request.flagged = Flagged::both;
  return request;
}

using IdPair = std::pair<ObjectId, ObjectId>;

inline void expectAnyAsBruteForce(const RandomWorld& world, const pcl_bsh::Scene& scene, const SceneResult& result)
{
  std::set<IdPair> expected, found, open, undecided;
  eachPartPair(world, scene, [&](ObjectId a, ObjectId b, std::uint32_t i, std::uint32_t j, double clearance) {
    const Verdict verdict =
        brute_force::anyCollision(placed(scene, a, i), placed(scene, b, j), within(clearance)).verdict;
    if (verdict != Verdict::free) (verdict == Verdict::colliding ? expected : open).insert({a, b});
  });
  for (const IdPair& pair : expected) open.erase(pair);
  for (const PartPair& pair : result.undecided)
    if (pair.a != pair.b) undecided.insert({pair.a, pair.b});
  EXPECT_EQ(undecided, open);
  for (const CollidingPair& pair : result.any) {
    EXPECT_TRUE(found.insert({pair.a, pair.b}).second) << "twice";
    const Placed a = placed(scene, pair.a, pair.part_a), b = placed(scene, pair.b, pair.part_b);
    const PairReach reach(a.hierarchy().view(), b.hierarchy().view(), *world.clearanceOf(pair.a, pair.b),
                          certainPlaces(a, b));
    EXPECT_TRUE(reach.holds(RecordDistance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose), pair.pair));
  }
  EXPECT_EQ(found, expected);
}

inline void expectFlagsAsBruteForce(const RandomWorld& world, const pcl_bsh::Scene& scene, const SceneResult& result)
{
  std::map<IdPair, std::vector<Verdict>> expected, found;
  const auto merge = [](std::vector<Verdict>& into, const std::vector<Verdict>& flags) {
    into.resize(flags.size());
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (into[i] != Verdict::colliding && flags[i] != Verdict::free) into[i] = flags[i];
  };
  eachPartPair(world, scene, [&](ObjectId a, ObjectId b, std::uint32_t i, std::uint32_t j, double clearance) {
    const FlagsResult flags = brute_force::collisionFlags(placed(scene, a, i), placed(scene, b, j), within(clearance));
    if (flags.colliding_a + flags.undecided_a == 0) return;
    merge(expected[{a, i}], flags.a);
    merge(expected[{b, j}], flags.b);
  });
  for (const FlaggedPart& part : result.flags) {
    found[{part.object, part.part}] = part.flags;
    EXPECT_EQ(part.colliding, countOf(part.flags, Verdict::colliding));
    EXPECT_EQ(part.undecided, countOf(part.flags, Verdict::undecided));
  }
  EXPECT_EQ(found, expected);
}

inline void expectDistancesAsBruteForce(const RandomWorld& world, const pcl_bsh::Scene& scene,
                                        const SceneResult& result, double limit)
{
  std::map<IdPair, double> expected, found;
  eachPartPair(world, scene, [&](ObjectId a, ObjectId b, std::uint32_t i, std::uint32_t j, double) {
    const DistanceResult closest = brute_force::closestPair(placed(scene, a, i), placed(scene, b, j));
    if (!closest.pair || closest.distance > limit) return;
    const auto entry = expected.emplace(IdPair{a, b}, closest.distance).first;
    entry->second = std::min(entry->second, closest.distance);
  });
  for (const DistantPair& pair : result.distance) found[{pair.a, pair.b}] = pair.distance;
  EXPECT_EQ(found, expected);
}

inline void expectSelfAsBruteForce(const pcl_bsh::Scene& scene, const SceneResult& result)
{
  std::set<std::pair<ObjectId, IdPair>> expected, found, open, undecided;
  for (ObjectId o = 0; o < scene.size(); ++o) {
    const SceneObject& whole = scene[o];
    for (std::uint32_t i = 0; i < whole.parts.size(); ++i)
      for (std::uint32_t j = i + 1; j < whole.parts.size(); ++j) {
        if (i == 0 && j == 1) continue; // adjacent
        const Verdict verdict = brute_force::anyCollision({*whole.parts[i].hierarchy, whole.parts[i].pose},
                                                          {*whole.parts[j].hierarchy, whole.parts[j].pose},
                                                          within(scene.options().clearance))
                                    .verdict;
        if (verdict != Verdict::free) (verdict == Verdict::colliding ? expected : open).insert({o, {i, j}});
      }
  }
  for (const SelfCollision& hit : result.self) found.insert({hit.object, {hit.part_a, hit.part_b}});
  for (const PartPair& pair : result.undecided)
    if (pair.a == pair.b) undecided.insert({pair.a, {pair.part_a, pair.part_b}});
  EXPECT_EQ(undecided, open);
  EXPECT_EQ(found, expected);
}

inline void expectContactsAsQueried(const RandomWorld& world, const pcl_bsh::Scene& scene, const SceneResult& result,
                                    std::size_t most)
{
  std::vector<std::vector<Contact>> expected;
  eachPartPair(world, scene, [&](ObjectId a, ObjectId b, std::uint32_t i, std::uint32_t j, double clearance) {
    const ContactsResult contacts = nearestContacts(placed(scene, a, i), placed(scene, b, j), {clearance, most});
    if (!contacts.contacts.empty()) expected.push_back(contacts.contacts);
  });
  ASSERT_EQ(result.contacts.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    ASSERT_EQ(result.contacts[k].contacts.size(), expected[k].size());
    for (std::size_t c = 0; c < expected[k].size(); ++c)
      EXPECT_EQ(result.contacts[k].contacts[c].pair, expected[k][c].pair);
  }
}

} // namespace pcl_bsh::test
