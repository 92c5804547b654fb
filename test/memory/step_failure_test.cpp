// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/scene.h>

#include "clouds.h"
#include "support/every_allocation.h"
#include "support/verdicts.h"

#include <tuple>

namespace pcl_bsh::test {
namespace {

const Cloud& ground()
{
  static const Cloud cloud = [] {
    std::vector<Point3> points;
    for (int i = -10; i <= 10; ++i)
      for (int j = -10; j <= 10; ++j) points.push_back({0.3 * i, 0.3 * j, i > 5 ? 0.2 : 0.0});
    return Cloud(points, Layout{Scalar::float64, 0, 0});
  }();
  return cloud;
}

const Cloud& body(bool deformed = false)
{
  const auto box = [](double size) {
    std::vector<Point3> points;
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j)
        for (int k = 0; k < 5; ++k) points.push_back({size * i, size * j, size * k});
    return Cloud(points, Layout{Scalar::float64, 0, 0});
  };
  static const Cloud as_given = box(0.11), grown = box(0.12);
  return deformed ? grown : as_given;
}

std::unique_ptr<pcl_bsh::Scene> freshScene(Response response, bool gravity, unsigned threads)
{
  SceneOptions options;
  options.clearance = 0.05;
  options.tolerance = 1e-3;
  options.threads = threads;
  Effects& effects = options.effects;
  effects.any = effects.flags = effects.first_contact = effects.swept = effects.self = true;
  effects.distance = 2.0;
  effects.contacts = 5;
  effects.response = response;
  effects.deform = 1.5;
  if (gravity) effects.gravity.emplace();
  auto scene = std::make_unique<pcl_bsh::Scene>(options);
  scene->add(fixedObject("ground", std::make_shared<SphereHierarchy>(ground().view())));
  for (int i = 0; i < 2; ++i) {
    SceneObject walker = object("walker " + std::to_string(i), std::make_shared<SphereHierarchy>(body().view()),
                                Eigen::Isometry3d(Eigen::Translation3d(0.9 * i - 1.0, 0.1 * i, 0.1 + 0.02 * i)));
    walker.parts.push_back(walker.parts[0]);
    walker.parts[1].name = "head";
    walker.parts[1].pose.translate(Eigen::Vector3d(0, 0, 0.46));
    walker.motion = VelocityMotion{{i == 1 ? -0.8 : 0.8, 0.1, 0}};
    scene->add(std::move(walker));
  }
  return scene;
}

/// Where everything is, and what the effects say of it.
std::vector<double> answerOf(const pcl_bsh::Scene& scene, const SceneResult& result)
{
  std::vector<double> answer{scene.time(), result.time};
  for (ObjectId i = 0; i < scene.size(); ++i) {
    const Eigen::Vector3d at = scene.worldPose(i).translation();
    answer.insert(answer.end(), {at.x(), at.y(), at.z()});
  }
  const auto add = [&](const auto& pair) {
    answer.insert(answer.end(), {static_cast<double>(pair.a), static_cast<double>(pair.b),
                                 static_cast<double>(pair.part_a), static_cast<double>(pair.part_b)});
  };
  for (const auto& pair : result.any) add(pair);
  for (const auto& pair : result.distance) {
    add(pair);
    answer.push_back(pair.distance);
  }
  for (const auto& pair : result.contacts) {
    add(pair);
    for (const Contact& contact : pair.contacts) answer.push_back(contact.distance);
  }
  for (const auto& pair : result.first_contact) {
    add(pair);
    answer.push_back(pair.fraction);
  }
  for (const auto* flagged : {&result.flags, &result.swept})
    for (const FlaggedPart& part : *flagged)
      answer.insert(answer.end(), {static_cast<double>(part.object), static_cast<double>(part.part),
                                   static_cast<double>(part.colliding)});
  for (const auto& self : result.self)
    answer.insert(answer.end(), {static_cast<double>(self.object), static_cast<double>(self.part_b)});
  for (const Outcome& outcome : result.outcomes)
    answer.insert(answer.end(),
                  {static_cast<double>(outcome.object), static_cast<double>(outcome.touched), outcome.travelled});
  return answer;
}

TEST(SceneAllocationFailure, OfQueries)
{
  for (const unsigned threads : {1u, 2u})
    failEachAllocation([&] { return freshScene(Response::none, false, threads); },
                       [](const auto& scene) { return answerOf(*scene, scene->query()); });
}

/// A step that fails has not been made: it can be made again.
TEST(SceneAllocationFailure, OfSteps)
{
  for (const auto& kind : {std::pair(Response::none, false), std::pair(Response::slide, true)}) {
    const auto make = [&] {
      auto scene = freshScene(kind.first, kind.second, 1);
      scene->step(0.1);
      return scene;
    };
    const auto expected = [&] {
      const auto scene = make();
      auto first = answerOf(*scene, scene->step(0.2));
      return std::pair(first, answerOf(*scene, scene->step(0.2)));
    }();
    for (const Shortage shortage : {Shortage::once, Shortage::lasting}) {
      bool failed = true;
      for (std::size_t k = 1; failed; k = nextFailure(k, shortage)) {
        releaseRetainedMemory();
        const auto scene = make();
        std::optional<SceneResult> result;
        {
          const FailingAllocation failing(k, shortage);
          try {
            result = scene->step(0.2);
          }
          catch (const std::bad_alloc&) {
          }
          failed = failing.hasHappened();
        }
        if (!result) result = scene->step(0.2);
        ASSERT_EQ(answerOf(*scene, *result), expected.first) << k;
        ASSERT_EQ(answerOf(*scene, scene->step(0.2)), expected.second) << k;
      }
    }
  }
}

TEST(SceneAllocationFailure, OfDeformation)
{
  failEachAllocation([&] { return freshScene(Response::none, false, 1); },
                     [](const auto& scene) {
                       scene->deform(1, 0, body(true).view());
                       return answerOf(*scene, scene->query());
                     });
}

TEST(SceneAllocationFailure, OfAddingObjects)
{
  failEachAllocation([&] { return freshScene(Response::none, false, 1); },
                     [hierarchy = std::make_shared<SphereHierarchy>(body().view())](const auto& scene) {
                       if (!scene->find("late"))
                         scene->add(object("late", hierarchy, Eigen::Isometry3d(Eigen::Translation3d(0.2, 0, 0))));
                       return answerOf(*scene, scene->query());
                     });
}

} // namespace
} // namespace pcl_bsh::test
