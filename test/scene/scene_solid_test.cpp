// SPDX-License-Identifier: BSD-3-Clause
// Solid objects in scenes: what they hold, against brute force of places and surfaces.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/scene/scene.h>

#include "scene_worlds.h"
#include "solid/meshes.h"
#include "support/brute_force/labels.h"
#include "support/random.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::at;
using test::Random;

class SceneOfSolids : public testing::Test {
protected:
  std::shared_ptr<SphereHierarchy> keep(const test::ClosedMesh& mesh)
  {
    meshes.push_back(mesh);
    return std::make_shared<SphereHierarchy>(viewOf(meshes.back().view()));
  }

  /// A box of this edge about the origin.
  std::shared_ptr<SphereHierarchy> box(double edge)
  {
    test::ClosedMesh mesh;
    mesh.add(test::boxMesh(), edge, {-edge / 2, -edge / 2, -edge / 2});
    return keep(mesh);
  }

  static SceneObject objectOf(const std::string& name, std::shared_ptr<SphereHierarchy> hierarchy, bool solid,
                              const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity())
  {
    SceneObject made = object(name, std::move(hierarchy), pose);
    made.parts[0].solid = solid;
    return made;
  }

  /// Whether a place of one is inside of the other, or on it.
  bool isEnclosed(const PointsView& places, const Eigen::Isometry3d& pose, std::size_t mesh,
                  const Eigen::Isometry3d& pose_of_mesh) const
  {
    const SphereHierarchy cloud(places);
    const LabelsResult labels = brute_force::labelPoints({cloud, pose}, {Solid(meshes[mesh].view()), pose_of_mesh});
    return labels.inside + labels.on_surface > 0;
  }

  std::deque<test::ClosedMesh> meshes;
  test::Shelf shelf;
  SceneOptions options;
};

TEST_F(SceneOfSolids, AnyFlagsAndDistancesOfRandomBodies)
{
  Random random(11);
  int enclosed_only = 0, free = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    meshes.clear();
    const bool solid_a = i % 3 != 0, solid_b = i % 3 != 1;
    const auto a = box(i % 2 == 0 ? 1.5 : 0.2);
    const auto b = keep(test::bumpyMesh(5, 0.15));
    const Eigen::Isometry3d pose_a = at(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    options = SceneOptions();
    options.clearance = 0.02;
    options.effects.any = options.effects.flags = true;
    options.effects.distance = std::numeric_limits<double>::infinity();
    options.remember = i % 2 == 0;
    Scene scene(options);
    scene.add(objectOf("a", a, solid_a, pose_a));
    scene.add(objectOf("b", b, solid_b));
    FlagsResult surfaces = collisionFlags({*a, pose_a}, {*b}, {options.clearance, Flagged::both});
    const bool b_holds = solid_b && isEnclosed(meshes[0].view().vertices, pose_a, 1, at(0, 0, 0));
    const bool a_holds = solid_a && isEnclosed(meshes[1].view().vertices, at(0, 0, 0), 0, pose_a);
    const bool collide = surfaces.colliding_a > 0 || a_holds || b_holds;
    enclosed_only += surfaces.colliding_a == 0 && (a_holds || b_holds);
    free += !collide;
    for (int again = 0; again < 2; ++again) {
      const SceneResult found = scene.query();
      EXPECT_EQ(found.any.size(), collide ? 1u : 0u);
      EXPECT_EQ(found.flags.empty(), !collide);
      ASSERT_EQ(found.distance.size(), 1u);
      const double nearest = found.distance[0].distance;
      if (surfaces.colliding_a == 0) {
        EXPECT_EQ(nearest < 0, a_holds || b_holds);
      }
      if (surfaces.colliding_a == 0 && (a_holds || b_holds)) { // one holds the whole other
        EXPECT_EQ(found.flags[0].colliding, found.flags[0].flags.size());
      }
    }
  }
  EXPECT_GT(enclosed_only, 3);
  EXPECT_GT(free, 3);
}

/// Not one more, where nothing is inside: each has its own.
TEST_F(SceneOfSolids, FlagsOfWhatIsOutsideAreThoseOfTheSurface)
{
  Random random(12);
  const auto tank = keep(test::bumpyMesh(5, 0.15));
  int some = 0;
  for (int i = 0; i < 200; ++i) {
    const auto probe = shelf.add(std::vector<Point3>{random.point([&] { return random.uniform(-0.2, 1.2); })});
    const FlagsResult expected = collisionFlags({*tank}, {*probe}, {0.1, Flagged::both});
    if (expected.colliding_a == 0 || isEnclosed(probe->view(), at(0, 0, 0), 0, at(0, 0, 0))) continue;
    some += expected.colliding_a < expected.a.size();
    options = SceneOptions();
    options.clearance = 0.1;
    options.effects.flags = true;
    Scene scene(options);
    const ObjectId of_tank = scene.add(objectOf("tank", tank, true));
    scene.add(objectOf("probe", probe, false));
    const SceneResult found = scene.query();
    ASSERT_EQ(found.flags.size(), 2u);
    for (const FlaggedPart& part : found.flags) EXPECT_EQ(part.flags, part.object == of_tank ? expected.a : expected.b);
  }
  EXPECT_GT(some, 10);
}

/// Each holds some of the other, to depths that differ.
TEST_F(SceneOfSolids, TheDeeperOfTwoCountsInEitherOrder)
{
  options.effects.distance = std::numeric_limits<double>::infinity();
  const auto fine = keep(test::bumpyMesh(24, 0.1)), coarse = keep(test::bumpyMesh(12, 0.1));
  const auto depth = [&](bool fine_first, bool fine_is_solid, bool coarse_is_solid) {
    Scene scene(options);
    const SceneObject of_fine = objectOf("fine", fine, fine_is_solid);
    const SceneObject of_coarse = objectOf("coarse", coarse, coarse_is_solid, at(0.45, 0, 0));
    scene.add(fine_first ? of_fine : of_coarse);
    scene.add(fine_first ? of_coarse : of_fine);
    return -scene.query().distance[0].distance;
  };
  const double of_fine = depth(true, false, true), of_coarse = depth(true, true, false);
  ASSERT_GT(of_fine, 0.0);
  ASSERT_GT(of_coarse, 0.0);
  ASSERT_NE(of_fine, of_coarse);
  EXPECT_EQ(depth(true, true, true), std::max(of_fine, of_coarse));
  EXPECT_EQ(depth(false, true, true), std::max(of_fine, of_coarse));
}

/// As of questions: its middle is enclosed, and its far side is told.
TEST_F(SceneOfSolids, ABallIsAsDeepAsItsFarSide)
{
  options.effects.distance = std::numeric_limits<double>::infinity();
  const auto tank = keep(test::boxMesh());
  const std::vector<Point3> middles = {{0.5, 0.5, 0.25}, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.0}};
  const std::vector<float> radii = {0.125f, 0.0f, 0.25f};
  const std::vector<double> expected = {-0.375, -0.5, -0.25};
  for (std::size_t i = 0; i < 3; ++i) {
    PointsView ball = viewOf(middles[i].data(), 1);
    ball.radii = &radii[i];
    const auto probe = std::make_shared<SphereHierarchy>(ball);
    for (const bool tank_first : {true, false}) {
      Scene scene(options);
      if (tank_first) scene.add(objectOf("tank", tank, true));
      scene.add(objectOf("probe", probe, false));
      if (!tank_first) scene.add(objectOf("tank", tank, true));
      const DistantPair found = scene.query().distance[0];
      EXPECT_EQ(found.distance, expected[i]) << i;
      EXPECT_LE(found.interval.lower, expected[i]);
      EXPECT_GE(found.interval.upper, expected[i]);
    }
  }
}

TEST_F(SceneOfSolids, WhatIsHeldFarFromAllOfTheSolidsVoxelsIsFound)
{
  options.effects.any = true;
  options.voxel_edge = 0.5;
  const auto tank = keep(test::bumpyMesh(40, 0.0)); // many voxels, none near its middle
  test::ClosedMesh large;
  large.add(meshes.back(), 100.0, {-50, -50, -50});
  const auto huge = keep(large);
  for (const bool solid : {false, true}) {
    Scene scene(options);
    scene.add(objectOf("tank", huge, solid));
    scene.add(objectOf("probe", shelf.add(std::vector<Point3>{{0.1, 0.2, 0.3}}), false));
    EXPECT_EQ(scene.query().any.size(), solid ? 1u : 0u);
    scene.setPose(1, at(200, 0, 0));
    EXPECT_TRUE(scene.query().any.empty());
    scene.setPose(1, at(1, 0, 0));
    EXPECT_EQ(scene.query().any.size(), solid ? 1u : 0u);
  }
}

TEST_F(SceneOfSolids, RememberedAnswersAreThoseOfAFreshScene)
{
  Random random(5);
  const auto tank = box(4.0);
  const auto probe = shelf.add(std::vector<Point3>{{0, 0, 0}, {0.1, 0, 0}});
  options.clearance = 0.05;
  options.effects.any = true;
  Scene scene(options);
  scene.add(objectOf("tank", tank, true));
  const ObjectId moving = scene.add(objectOf("probe", probe, false));
  double x = -4.0;
  for (int i = 0; i < 80; ++i) {
    x += random.uniform(0.0, 0.2);
    scene.setPose(moving, at(x, 0, 0));
    const bool collides = x + 0.1 >= -2.05 && x <= 2.05;
    EXPECT_EQ(!scene.query().any.empty(), collides) << x;
  }
}

TEST_F(SceneOfSolids, AMotionThatBeginsInsideMeetsAtItsFirstInstant)
{
  options.effects.first_contact = options.effects.swept = true;
  const auto tank = box(4.0);
  const auto probe = shelf.add(std::vector<Point3>{{0, 0, 0}});
  const auto contactOf = [&](bool solid, double from, double to) {
    Scene scene(options);
    scene.add(objectOf("tank", tank, solid));
    const ObjectId moving = scene.add(objectOf("probe", probe, false, at(from, 0.3, 0.2)));
    scene.query();
    scene.setPose(moving, at(to, 0.3, 0.2));
    return scene.query();
  };
  SceneResult found = contactOf(true, 0, 1); // never near the wall
  ASSERT_EQ(found.first_contact.size(), 1u);
  EXPECT_EQ(found.first_contact[0].fraction, 0.0);
  EXPECT_EQ(found.certain_contact.size(), 1u);
  ASSERT_EQ(found.swept.size(), 2u);
  EXPECT_EQ(found.swept[0].colliding, 12u);
  EXPECT_EQ(found.swept[1].colliding, 1u);
  found = contactOf(true, 0, 4); // and out
  EXPECT_EQ(found.first_contact.at(0).fraction, 0.0);
  found = contactOf(false, 0, 4);
  EXPECT_NEAR(found.first_contact.at(0).fraction, 0.5, 1e-3);
  found = contactOf(true, 4, 0); // in: where it meets the wall
  EXPECT_NEAR(found.first_contact.at(0).fraction, 0.5, 1e-3);
  EXPECT_EQ(found.swept.at(0).colliding, 12u);
  found = contactOf(false, 0, 1);
  EXPECT_TRUE(found.first_contact.empty());
  EXPECT_TRUE(found.swept.empty());
  found = contactOf(true, 4, 3);
  EXPECT_TRUE(found.first_contact.empty());
}

/// Its body is flagged as a whole, whichever of the two was added first.
TEST_F(SceneOfSolids, WhatPassesThroughASolidFlagsItsBody)
{
  options.effects.swept = true;
  const auto tank = box(1.0);
  const auto probe = shelf.add(std::vector<Point3>{{0, 0, 0}});
  for (const bool solid : {false, true})
    for (const bool tank_first : {false, true}) {
      Scene scene(options);
      if (tank_first) scene.add(objectOf("tank", tank, solid));
      const ObjectId moving = scene.add(objectOf("probe", probe, false, at(-4, 0.3, 0.2)));
      if (!tank_first) scene.add(objectOf("tank", tank, solid));
      scene.query();
      scene.setPose(moving, at(4, 0.3, 0.2));
      const SceneResult found = scene.query();
      ASSERT_EQ(found.swept.size(), 2u);
      EXPECT_EQ(found.swept[moving].colliding, 1u);
      EXPECT_EQ(found.swept[1 - moving].colliding, solid ? 12u : 2u) << "the triangles that it passes";
    }
}

/// Out of the hollow and back into it by an arc: it meets the hollow's surface alone, and the body about it holds it
/// meanwhile.
TEST_F(SceneOfSolids, WhatLeavesAHollowIsHeldByTheBodyAboutIt)
{
  options.effects.swept = true;
  test::ClosedMesh mesh;
  mesh.add(test::boxMesh(), 1.0, {-0.5, -0.5, -0.5});
  mesh.add(test::boxMesh(), 0.6, {-0.3, -0.3, -0.3}, true);
  mesh.add(test::boxMesh(), 1.0, {9, 0, 0}); // another body, far away
  const auto hollow = keep(mesh);
  const auto probe = shelf.add(std::vector<Point3>{{0.25, 0.24, 0.02}, {-0.25, -0.24, -0.02}});
  Scene scene(options);
  scene.add(objectOf("hollow", hollow, true));
  SceneObject turning = objectOf("probe", probe, false);
  turning.motion = VelocityMotion{{0, 0, 0}, {0, 0, -std::acos(0.0)}};
  scene.add(turning);
  const SceneResult found = scene.step(1.0);
  ASSERT_EQ(found.swept.size(), 2u);
  std::vector<Verdict> expected(36, Verdict::free);
  std::fill(expected.begin(), expected.begin() + 24, Verdict::colliding);
  EXPECT_EQ(found.swept[0].flags, expected);
}

TEST_F(SceneOfSolids, WhatBeginsInsideIsStuckAndToldSo)
{
  const auto tank = box(4.0);
  const auto probe = box(0.5);
  for (const Response response : {Response::stop, Response::slide})
    for (const bool probe_is_solid : {false, true})
      for (const bool tank_moves : {false, true}) {
        options.effects.response = response;
        Scene scene(options);
        scene.add(objectOf("tank", tank, true));
        scene.add(objectOf("probe", probe, probe_is_solid, at(0.2, 0.1, 0)));
        const ObjectId moving = tank_moves ? 0 : 1;
        scene.setMotion(moving, VelocityMotion{{10, 0, 0}, {0, 0, 0}});
        const Eigen::Isometry3d before = scene[moving].pose;
        const SceneResult found = scene.step(1.0);
        ASSERT_EQ(found.outcomes.size(), 1u);
        EXPECT_TRUE(found.outcomes[0].stuck);
        EXPECT_TRUE(found.outcomes[0].touched);
        EXPECT_EQ(found.outcomes[0].against, 1 - moving);
        EXPECT_EQ(scene[moving].pose.matrix(), before.matrix());
      }
  // Hollow: it goes up to the wall.
  Scene scene(options);
  scene.add(objectOf("tank", tank, false));
  const ObjectId moving = scene.add(objectOf("probe", probe, false));
  scene.setMotion(moving, VelocityMotion{{10, 0, 0}, {0, 0, 0}});
  const SceneResult found = scene.step(1.0);
  EXPECT_FALSE(found.outcomes[0].stuck);
  EXPECT_NEAR(scene[moving].pose.translation().x(), 1.75, 1e-3);
}

TEST_F(SceneOfSolids, WhatComesFromOutsideSlidesAsOnASurface)
{
  options.effects.response = Response::slide;
  std::vector<Eigen::Matrix4d> ends;
  for (const bool solid : {false, true}) {
    Scene scene(options);
    scene.add(objectOf("tank", box(4.0), solid));
    const ObjectId moving = scene.add(objectOf("probe", box(0.5), solid, at(-4, 0, 0)));
    scene.setMotion(moving, VelocityMotion{{3, 0.4, 0}, {0, 0, 0}});
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(scene.step(1.0).outcomes.at(0).stuck);
    EXPECT_NEAR(scene[moving].pose.translation().x(), -2.25, 1e-3);
    EXPECT_GT(scene[moving].pose.translation().y(), 1.0);
    ends.push_back(scene[moving].pose.matrix());
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST_F(SceneOfSolids, PartsOfOneObjectHoldEachOther)
{
  options.effects.self = true;
  for (const bool solid : {false, true}) {
    Scene scene(options);
    SceneObject robot = objectOf("robot", box(4.0), solid);
    robot.parts.push_back({"inner", box(1.0), at(0.5, 0, 0)});
    scene.add(std::move(robot));
    EXPECT_EQ(scene.query().self.size(), solid ? 1u : 0u);
    scene.setPartPose(0, 1, at(9, 0, 0));
    EXPECT_TRUE(scene.query().self.empty());
  }
  Scene scene(options); // the later part holds the earlier
  SceneObject robot = objectOf("robot", box(1.0), false);
  robot.parts.push_back({"outer", box(4.0), at(0.5, 0, 0)});
  robot.parts[1].solid = true;
  scene.add(std::move(robot));
  EXPECT_EQ(scene.query().self.size(), 1u);
}

TEST_F(SceneOfSolids, UncertainPlacesMayStillBeOutside)
{
  options.effects.any = options.effects.flags = options.effects.first_contact = true;
  const std::vector<Point3> points = {{1.5, 0, 0}};
  for (const double uncertainty : {0.25, 1.0}) {
    SCOPED_TRACE(uncertainty);
    PointsView view = viewOf(points[0].data(), 1);
    view.uncertainty = uncertainty;
    Scene scene(options);
    scene.add(objectOf("tank", box(4.0), true));
    scene.add(objectOf("probe", std::make_shared<SphereHierarchy>(view), false));
    const SceneResult found = scene.query();
    const bool certain = uncertainty < 0.5;
    EXPECT_EQ(found.any.size(), certain ? 1u : 0u);
    EXPECT_EQ(found.undecided.size(), certain ? 0u : 1u);
    ASSERT_EQ(found.flags.size(), 2u);
    EXPECT_EQ(found.flags[0].colliding, certain ? 12u : 0u);
    EXPECT_EQ(found.flags[0].undecided, certain ? 0u : 12u);
    EXPECT_EQ(found.flags[1].undecided, certain ? 0u : 1u);
    EXPECT_EQ(found.first_contact.size(), 1u);
    EXPECT_EQ(found.certain_contact.size(), certain ? 1u : 0u);
  }
}

/// A point near the wall may be outside; another one is inside wherever it truly is.
TEST_F(SceneOfSolids, OfUncertainPlacesOneThatIsCertainlyHeldDecides)
{
  options.effects.any = options.effects.flags = options.effects.first_contact = options.effects.self = true;
  const std::vector<Point3> points = {{1.5, 0, 0}, {0, 0, 0}};
  PointsView view = viewOf(points[0].data(), 2);
  view.uncertainty = 1.0;
  const auto probe = std::make_shared<SphereHierarchy>(view);
  const auto tank = box(4.0);
  Scene scene(options);
  scene.add(objectOf("tank", tank, true));
  scene.add(objectOf("probe", probe, false));
  SceneObject both = objectOf("both", tank, true, at(100, 0, 0));
  both.parts.push_back({"inner", probe, at(0, 0, 0)});
  scene.add(both);
  const SceneResult found = scene.query();
  ASSERT_EQ(found.any.size(), 1u);
  EXPECT_EQ(found.any[0].pair.b, 1u);
  EXPECT_LT(found.any[0].pair.a, 12u);
  EXPECT_TRUE(found.undecided.empty());
  ASSERT_EQ(found.flags.size(), 2u);
  EXPECT_EQ(found.flags[0].colliding, 12u);
  EXPECT_EQ(found.flags[1].flags, test::verdictsOf({2, 1}));
  ASSERT_EQ(found.first_contact.size(), 1u);
  EXPECT_EQ(found.first_contact[0].pair.b, 0u) << "the surface, which it may touch";
  ASSERT_EQ(found.certain_contact.size(), 1u);
  EXPECT_EQ(found.certain_contact[0].pair.b, 1u);
  EXPECT_EQ(found.certain_contact[0].fraction, 0.0);
  ASSERT_EQ(found.self.size(), 1u);
  EXPECT_EQ(found.self[0].pair.b, 1u);
}

TEST_F(SceneOfSolids, FollowsPointsThatMove)
{
  options.effects.any = true;
  options.effects.deform = 2.0;
  test::ClosedMesh mesh;
  mesh.add(test::boxMesh(), 2.0, {-1, -1, -1});
  test::ClosedMesh moved = mesh;
  for (double& x : moved.xyz) x += 5.0;
  const auto tank = keep(mesh);
  meshes.push_back(moved);
  Scene scene(options);
  scene.add(objectOf("tank", tank, true));
  scene.add(objectOf("probe", shelf.add(std::vector<Point3>{{5, 5, 5}}), false));
  EXPECT_TRUE(scene.query().any.empty());
  scene.deform(0, 0, viewOf(meshes.back().view()));
  EXPECT_EQ(scene.query().any.size(), 1u);
}

TEST_F(SceneOfSolids, RefusesWhatDoesNotClose)
{
  Scene scene(options);
  test::ClosedMesh mesh = test::boxMesh();
  mesh.corners.resize(mesh.corners.size() - 3);
  const auto open = keep(mesh);
  EXPECT_THAT([&] { scene.add(objectOf("tank", open, true)); },
              testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("object 'tank': 3 edges are open")));
  EXPECT_THAT(
      [&] {
        scene.add(objectOf("points", shelf.add(std::vector<Point3>{{0, 0, 0}}), true));
      },
      testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("is solid, but has no faces")));
  EXPECT_EQ(scene.size(), 0u);
  scene.add(objectOf("tank", open, false));
}

} // namespace
} // namespace pcl_bsh
