// SPDX-License-Identifier: BSD-3-Clause
// Objects that give way: stop, slide, gravity.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/scene/scene.h>

#include "scene_worlds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace pcl_bsh {
namespace {

using test::at;
using test::joined;
using test::Random;
using test::sheet;
using test::Shelf;

constexpr double tolerance = 1e-4;

SceneOptions responding(Response response, double clearance)
{
  SceneOptions options;
  options.effects.response = response;
  options.clearance = clearance;
  options.tolerance = tolerance;
  return options;
}

Eigen::Vector3d place(const Scene& scene, ObjectId object)
{
  return scene[object].pose.translation();
}

double distance(const Scene& scene, ObjectId a, ObjectId b)
{
  return brute_force::closestPair({*scene[a].parts[0].hierarchy, scene.worldPose(a)},
                                  {*scene[b].parts[0].hierarchy, scene.worldPose(b)})
      .distance;
}

bool collides(const Scene& scene, ObjectId a, ObjectId b)
{
  AnyRequest request;
  request.clearance = scene.options().clearance;
  return brute_force::anyCollision({*scene[a].parts[0].hierarchy, scene.worldPose(a)},
                                   {*scene[b].parts[0].hierarchy, scene.worldPose(b)}, request)
      .pair.has_value();
}

/// A wall in the plane x = 0, points 0.1 apart.
std::vector<Point3> wall()
{
  return sheet({0, -2, -2}, {0, 0.1, 0}, {0, 0, 0.1}, 41, 41);
}

/// A dot passes a post: half-way it is nearer than the clearance by a rounding, and it is farther at both ends.
TEST(SceneResponse, StopsAndFirstContactsSeeWhatIsARoundingDeep)
{
  struct Pass {
    double way, offset;
    std::size_t along, across; ///< axes
  };
  for (const Pass& pass : {Pass{7e-8, 0, 0, 1},
                           {3e-8, 0, 1, 2},
                           {1e-7, 0, 2, 0},
                           {1e-6, 1000, 1, 0},
                           {5e-5, 5e6, 0, 1},
                           {6e-5, 5e6, 2, 1}}) {
    SCOPED_TRACE(testing::Message() << pass.way << " at " << pass.offset);
    Shelf shelf;
    const auto dot = shelf.add({{0, 0, 0}});
    const auto placed = [&](double along, double across) {
      Eigen::Vector3d at = Eigen::Vector3d::Zero();
      at[static_cast<Eigen::Index>(pass.along)] = pass.offset + along;
      at[static_cast<Eigen::Index>(pass.across)] = across;
      return Eigen::Isometry3d(Eigen::Translation3d(at));
    };
    const Eigen::Isometry3d post = placed(0, pass.offset);
    const auto collidesAt = [&](double along, double across) {
      return brute_force::anyCollision({*dot, post}, {*dot, placed(along, across)}, {1.0, {}}).pair.has_value();
    };
    double near = pass.offset + 0.5, across = pass.offset + 1.5; // the least place that is free at both ends
    for (double middle = near + 0.5; middle > near && middle < across; middle = near + 0.5 * (across - near))
      (collidesAt(-pass.way, middle) || collidesAt(pass.way, middle) ? near : across) = middle;
    ASSERT_TRUE(collidesAt(0.0, across));

    SceneOptions options = responding(Response::none, 1.0);
    options.effects.first_contact = options.effects.swept = true;
    Scene watched(options);
    watched.add(fixedObject("post", dot, post));
    const ObjectId passing = watched.add(object("dot", dot, placed(-pass.way, across)));
    watched.query();
    watched.setPose(passing, placed(pass.way, across));
    const SceneResult seen = watched.query();
    EXPECT_EQ(seen.first_contact.size(), 1u);
    EXPECT_EQ(seen.swept.size(), 2u);

    for (const Response response : {Response::stop, Response::slide}) {
      Scene scene(responding(response, 1.0));
      scene.add(fixedObject("post", dot, post));
      SceneObject mover = object("dot", dot, placed(-pass.way, across));
      Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
      velocity[static_cast<Eigen::Index>(pass.along)] = 2 * pass.way;
      mover.motion = VelocityMotion{velocity};
      const ObjectId id = scene.add(mover);
      const SceneResult stepped = scene.step(1);
      EXPECT_TRUE(stepped.outcomes.at(0).touched);
      EXPECT_FALSE(stepped.outcomes.at(0).stuck);
      EXPECT_FALSE(collides(scene, 0, id));
      if (response == Response::stop) {
        EXPECT_EQ(place(scene, id), placed(-pass.way, across).translation());
      }
    }
  }
  // The nearest place is a rounding beyond the clearance: nothing is met.
  Shelf shelf;
  const auto dot = shelf.add({{0, 0, 0}});
  Scene scene(responding(Response::stop, 1.0));
  scene.add(fixedObject("post", dot));
  SceneObject mover = object("dot", dot, at(-7e-8, std::nextafter(1.0, 2.0), 0));
  mover.motion = VelocityMotion{{1.4e-7, 0, 0}};
  scene.add(mover);
  EXPECT_FALSE(scene.step(1).outcomes.at(0).touched);
}

TEST(SceneResponse, StopHaltsAtTheFirstContact)
{
  Shelf shelf;
  Scene scene(responding(Response::stop, 0.3));
  scene.add(fixedObject("wall", shelf.add(wall())));
  SceneObject ball = object("ball", shelf.add({{0, 0, 0}}), at(-5, 0, 0));
  ball.motion = VelocityMotion{{1, 0, 0}};
  const ObjectId id = scene.add(ball);
  for (int step = 0; step < 4; ++step) {
    const SceneResult result = scene.step(1);
    EXPECT_EQ(place(scene, id), Eigen::Vector3d(-4 + step, 0, 0));
    ASSERT_EQ(result.outcomes.size(), 1u);
    EXPECT_FALSE(result.outcomes[0].touched);
    EXPECT_EQ(result.outcomes[0].travelled, 1.0);
  }
  for (int step = 0; step < 3; ++step) {
    const SceneResult result = scene.step(1);
    EXPECT_FALSE(collides(scene, 0, id));
    EXPECT_LE(distance(scene, 0, id), 0.3 + tolerance);
    EXPECT_TRUE(result.outcomes[0].touched);
    EXPECT_EQ(result.outcomes[0].against, 0u);
  }
  EXPECT_GT(scene.step(1).cost(Effect::stop).pairs, 0u);
  scene.setMotion(id, VelocityMotion{{-1, 0, 0}}); // and can leave again
  const double before = place(scene, id).x();
  scene.step(1);
  EXPECT_NEAR(place(scene, id).x(), before - 1, 1e-12);
}

TEST(SceneResponse, StopNeverPenetratesAndNeverHaltsEarly)
{
  int halted = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Shelf shelf;
    Scene scene(responding(Response::stop, random.uniform(0.02, 0.2)));
    scene.add(fixedObject("rock", shelf.add(test::makePoints(random.pick(test::all_shapes), 200, 1, random))));
    const auto shape = [&] { return test::all_shapes[static_cast<std::size_t>(random.integer(0, 6))]; };
    Eigen::Isometry3d start = random.pose(0.5);
    start.translation().x() -= 6;
    SceneObject thing = object("thing", shelf.add(test::makePoints(shape(), 100, 0.5, random)), start);
    const Eigen::Isometry3d turn = random.pose(0);
    Eigen::Isometry3d end = start;
    end.translation().x() += 12;
    if (random.chance(0.6)) end.linear() = turn.linear();
    thing.motion = WaypointMotion{{0, 4}, {start, end}};
    const ObjectId id = scene.add(thing);
    for (int step = 0; step < 5; ++step) {
      const SceneResult result = scene.step(1);
      ASSERT_FALSE(collides(scene, 0, id));
      if (result.outcomes.empty() || !result.outcomes[0].touched) continue;
      ++halted;
      ASSERT_LE(distance(scene, 0, id), scene.options().clearance + tolerance);
    }
  }
  EXPECT_GT(halted, 15);
}

TEST(SceneResponse, SlideKeepsTheFreeComponent)
{
  Shelf shelf;
  // The wall's spheres of radius 1 bulge by 1.3 mm between points: as good as a plane.
  Scene scene(responding(Response::slide, 1.0));
  scene.add(fixedObject("wall", shelf.add(wall())));
  SceneObject ball = object("ball", shelf.add({{0, 0, 0}}), at(-1.5, -1, 0));
  ball.motion = VelocityMotion{{1, 0.5, 0.25}};
  const ObjectId id = scene.add(ball);
  for (int step = 1; step <= 20; ++step) {
    const SceneResult result = scene.step(0.1);
    EXPECT_FALSE(collides(scene, 0, id));
    EXPECT_EQ(result.outcomes[0].touched, step > 5) << step;
  }
  const Eigen::Vector3d p = place(scene, id);
  EXPECT_NEAR(p.x(), -1, 0.003);
  EXPECT_NEAR(p.y(), 0, 0.02); // at least 0.98 of the tangential motion of 1.0 in y, 0.5 in z
  EXPECT_NEAR(p.z(), 0.5, 0.01);
}

TEST(SceneResponse, SlideStopsInACorner)
{
  Shelf shelf;
  Scene scene(responding(Response::slide, 1.0));
  const auto second = sheet({-4, 0, -2}, {0.1, 0, 0}, {0, 0, 0.1}, 41, 41); // y = 0
  const auto third = sheet({-4, -2, 2}, {0.1, 0, 0}, {0, 0.1, 0}, 41, 21);  // z = 2
  scene.add(fixedObject("corner", shelf.add(joined(joined(wall(), second), third))));
  SceneObject ball = object("ball", shelf.add({{0, 0, 0}}), at(-2, -2, 0));
  ball.motion = VelocityMotion{{1, 1.1, 0.4}};
  const ObjectId id = scene.add(ball);
  for (int step = 0; step < 20; ++step) { // into the edge, and up along it
    scene.step(0.1);
    ASSERT_FALSE(collides(scene, 0, id));
  }
  EXPECT_NEAR(place(scene, id).x(), -1, 0.01);
  EXPECT_NEAR(place(scene, id).y(), -1, 0.01);
  EXPECT_NEAR(place(scene, id).z(), 0.8, 0.03);
  for (int step = 0; step < 20; ++step) scene.step(0.1); // into the corner
  const Eigen::Vector3d corner = place(scene, id);
  EXPECT_NEAR(corner.z(), 1, 0.01);
  const SceneResult result = scene.step(0.1);
  EXPECT_TRUE(result.outcomes[0].touched);
  EXPECT_LT((place(scene, id) - corner).norm(), 0.003);
  EXPECT_FALSE(collides(scene, 0, id));
}

/// The slide stops at an obstacle that the straight path would not have come near.
TEST(SceneResponse, SlideStopsAtWhatLiesBesideTheStraightWay)
{
  Shelf shelf;
  Scene scene(responding(Response::slide, 0.1));
  scene.add(fixedObject("slope", shelf.add(sheet({-1, -1, -0.5}, {0.01, 0.01, 0}, {0, 0, 0.02}, 201, 51))));
  const ObjectId post = scene.add(fixedObject("post", shelf.add({{0.2, 0.2 + 0.1 * std::sqrt(2.0), 0}})));
  SceneObject ball = object("ball", shelf.add({{0, 0, 0}}), at(-1, 0, 0));
  ball.motion = VelocityMotion{{2, 0, 0}};
  const ObjectId id = scene.add(ball);
  const SceneResult result = scene.step(1); // up the slope, into the post
  EXPECT_NEAR(distance(scene, post, id), 0.1, 0.005);
  EXPECT_FALSE(collides(scene, post, id));
  EXPECT_LT(place(scene, id).y(), 0.3);
  EXPECT_TRUE(result.outcomes[0].touched);
}

TEST(SceneResponse, SlideNeverPenetrates)
{
  double travelled = 0.0, wanted = 0.0;
  for (std::uint64_t seed = 500; seed < 512; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Shelf shelf;
    Scene scene(responding(Response::slide, random.uniform(0.02, 0.3)));
    scene.add(fixedObject("rock", shelf.add(test::makePoints(random.pick(test::all_shapes), 300, 1, random))));
    Eigen::Isometry3d start = random.pose(0.5);
    start.translation().x() -= 3;
    SceneObject thing =
        object("thing", shelf.add(test::makePoints(random.pick(test::all_shapes), 60, 0.3, random)), start);
    thing.motion = VelocityMotion{{1, random.uniform(-0.5, 0.5), 0}, {0, 0, random.uniform(-1, 1)}};
    const ObjectId id = scene.add(thing);
    if (collides(scene, 0, id)) continue;
    for (int step = 0; step < 20; ++step) {
      const SceneResult result = scene.step(0.2);
      ASSERT_FALSE(collides(scene, 0, id)) << step;
      ASSERT_FALSE(result.outcomes[0].stuck);
      travelled += result.outcomes[0].travelled;
      wanted += result.outcomes[0].wanted;
    }
  }
  EXPECT_GT(travelled, 0.5 * wanted);
}

TEST(SceneResponse, WhatCollidesFromTheStartStaysAndSaysSo)
{
  Shelf shelf;
  const auto point = shelf.add({{0, 0, 0}});
  for (const Response response : {Response::stop, Response::slide}) {
    Scene scene(responding(response, 0.5));
    scene.add(object("one", point));
    SceneObject other = object("other", point, at(0.5, 0, 0)); // touching counts
    other.motion = VelocityMotion{{1, 0, 0}};
    scene.add(other);
    const SceneResult result = scene.step(1);
    EXPECT_TRUE(result.outcomes[0].stuck);
    EXPECT_EQ(result.outcomes[0].against, 0u);
    EXPECT_EQ(place(scene, 1), Eigen::Vector3d(0.5, 0, 0));
  }
}

TEST(SceneResponse, TooManyPairsToFollowAreFollowedInShorterWays)
{
  Shelf shelf;
  const auto dense = sheet({0, -1, -1}, {0, 0.01, 0}, {0, 0, 0.01}, 200, 200);
  for (const auto& [response, turn] : {std::pair(Response::stop, 0.0), {Response::slide, 0.0}, {Response::stop, 0.1}}) {
    Scene scene(responding(response, 0.1));
    scene.add(fixedObject("wall", shelf.add(dense)));
    SceneObject plate =
        object("plate", shelf.add(sheet({0, -0.5, -0.5}, {0, 0.02, 0}, {0, 0, 0.02}, 50, 50)), at(-3, 0, 0));
    plate.motion = VelocityMotion{{5, 0, 0}, {turn, 0, 0}};
    scene.add(plate);
    const SceneResult result = scene.step(1);
    EXPECT_TRUE(result.outcomes[0].touched);
    EXPECT_GT(place(scene, 1).x(), -0.1 - tolerance);
    EXPECT_LT(place(scene, 1).x(), -0.1);
  }
}

/// So many points at one place that no way is short enough to follow all pairs.
TEST(SceneResponse, HeapsHaltBeforeTheyMeet)
{
  Shelf shelf;
  const auto heap = shelf.add(std::vector<Point3>(200, Point3{0, 0, 0}));
  for (const auto& [response, turn] : {std::pair(Response::stop, 0.0), {Response::slide, 0.0}, {Response::stop, 0.1}}) {
    Scene scene(responding(response, 0.1));
    scene.add(object("beside", shelf.add({{0, 0, 0}}), at(0, 5, 0)));
    const ObjectId rest = scene.add(object("at rest", heap));
    SceneObject mover = object("mover", heap, at(-3, 0, 0));
    mover.motion = VelocityMotion{{5, 0, 0}, {turn, 0, 0}};
    const ObjectId id = scene.add(mover);
    for (int step = 0; step < 2; ++step) {
      const SceneResult result = scene.step(1);
      ASSERT_EQ(result.outcomes.size(), 1u);
      EXPECT_TRUE(result.outcomes[0].touched);
      EXPECT_FALSE(result.outcomes[0].stuck);
      EXPECT_EQ(result.outcomes[0].against, rest);
      EXPECT_GT(distance(scene, rest, id), 0.1);
      EXPECT_LE(distance(scene, rest, id), 0.1 + tolerance);
    }
  }
}

/// Without a response it goes where its motion leads, into a wall if need be, and is not lifted there to fall again.
TEST(SceneResponse, WhatIsStuckStaysAtItsHeight)
{
  Shelf shelf;
  SceneOptions options = responding(Response::none, 0.1);
  options.effects.gravity = Gravity{};
  Scene scene(options);
  scene.add(object("wall", shelf.add(sheet({1, -1, -1}, {0, 0.05, 0}, {0, 0, 0.05}, 41, 61))));
  SceneObject mover = object("mover", shelf.add({{0, 0, 0}}));
  mover.motion = VelocityMotion{{1, 0, 0}, {0, 0, 0}};
  const ObjectId id = scene.add(mover);
  const SceneResult result = scene.step(1);
  ASSERT_EQ(result.outcomes.size(), 1u);
  EXPECT_TRUE(result.outcomes[0].stuck);
  EXPECT_EQ(place(scene, id), Eigen::Vector3d(1, 0, 0));
}

/// Ground with a step of this height at x = 0, and a wall at x = 3; points 5 cm apart.
std::vector<Point3> stairs(double step)
{
  auto points = sheet({-3, -1, 0}, {0.05, 0, 0}, {0, 0.05, 0}, 61, 41);
  points = joined(points, sheet({0, -1, step}, {0.05, 0, 0}, {0, 0.05, 0}, 61, 41));
  for (double z = 0.0; z < step; z += 0.05) points = joined(points, sheet({0, -1, z}, {0, 0.05, 0}, {0, 0, 1}, 41, 1));
  return joined(points, sheet({3, -1, 0}, {0, 0.05, 0}, {0, 0, 0.05}, 41, 60));
}

TEST(SceneResponse, GravityClimbsStepsUpToItsHeight)
{
  for (const Response response : {Response::stop, Response::slide})
    for (const double height : {0.2, 0.4}) {
      SCOPED_TRACE(height);
      Shelf shelf;
      SceneOptions options = responding(response, 0.1);
      options.effects.gravity = Gravity{};
      Scene scene(options);
      scene.add(fixedObject("ground", shelf.add(stairs(height))));
      std::vector<Point3> post;
      for (int i = 0; i <= 17; ++i) post.push_back({0, 0, 0.1 * i});
      SceneObject man = object("man", shelf.add(post), at(-2, 0, 0.2));
      man.motion = VelocityMotion{{0.5, 0, 0}};
      const ObjectId id = scene.add(man);
      bool grounded = true;
      for (int step = 0; step < 80; ++step) {
        const SceneResult result = scene.step(0.1);
        ASSERT_FALSE(step % 8 == 0 && collides(scene, 0, id)) << step;
        grounded = grounded && result.outcomes[0].grounded;
      }
      EXPECT_TRUE(grounded);
      EXPECT_NEAR(place(scene, id).x(), height < 0.3 ? 1.75 : -0.1, 0.26);
      EXPECT_NEAR(place(scene, id).z(), height < 0.3 ? 0.3 : 0.1, 0.03);
    }
}

TEST(SceneResponse, GravityGoesDownAgainAndFallsWhereThereIsNoGround)
{
  Shelf shelf;
  SceneOptions options = responding(Response::slide, 0.1);
  options.effects.gravity = Gravity{};
  Scene scene(options);
  scene.add(fixedObject("ground", shelf.add(stairs(0.2))));
  SceneObject ball = object("ball", shelf.add({{0, 0, 0}}), at(0.5, 0, 0.35));
  ball.motion = VelocityMotion{{-0.5, 0, 0}};
  const ObjectId id = scene.add(ball);
  for (int step = 0; step < 30; ++step) {
    EXPECT_TRUE(scene.step(0.1).outcomes[0].grounded);
    ASSERT_FALSE(step % 8 == 0 && collides(scene, 0, id));
  }
  EXPECT_NEAR(place(scene, id).x(), -1, 0.1);
  EXPECT_NEAR(place(scene, id).z(), 0.1, 0.01);
  scene.setMotion(id, VelocityMotion{{-10, 0, 0}});
  scene.step(1);
  const double height = place(scene, id).z();
  EXPECT_FALSE(scene.step(1).outcomes[0].grounded);
  EXPECT_NEAR(place(scene, id).z(), height - 0.3, 1e-9);
}

TEST(SceneResponse, GravityAloneFollowsTheGround)
{
  Shelf shelf;
  SceneOptions options = responding(Response::none, 0.1);
  options.effects.gravity = Gravity{};
  Scene scene(options);
  scene.add(fixedObject("ground", shelf.add(stairs(0.2))));
  SceneObject ball = object("ball", shelf.add({{0, 0, 0}}), at(-1, 0, 0.2));
  ball.motion = VelocityMotion{{0.5, 0, 0}};
  const ObjectId id = scene.add(ball);
  for (int step = 0; step < 40; ++step) scene.step(0.1);
  EXPECT_NEAR(place(scene, id).x(), 1, 1e-9);
  EXPECT_NEAR(place(scene, id).z(), 0.3, 0.01);
}

TEST(SceneResponse, ObjectsGiveWayToEachOther)
{
  Random random(9);
  Shelf shelf;
  SceneOptions options = responding(Response::slide, 0.05);
  options.effects.any = true;
  Scene scene(options);
  const auto cloud = shelf.add(test::makePoints(test::Shape::sphere, 100, 0.4, random));
  for (int i = 0; i < 27; ++i) {
    SceneObject ball = object("ball " + std::to_string(i), cloud, at(i % 3, i / 3 % 3, i / 9));
    const Point3 v = random.point([&] { return random.uniform(-1, 1); });
    ball.motion = VelocityMotion{{v[0], v[1], v[2]}, {0, 0, 1}};
    scene.add(ball);
  }
  int touched = 0;
  for (int step = 0; step < 30; ++step) {
    const SceneResult result = scene.step(0.1);
    ASSERT_TRUE(result.any.empty()) << step;
    for (const Outcome& outcome : result.outcomes) touched += outcome.touched;
  }
  EXPECT_GT(touched, 50);
}

} // namespace
} // namespace pcl_bsh
