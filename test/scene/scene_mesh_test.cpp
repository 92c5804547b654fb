// SPDX-License-Identifier: BSD-3-Clause
// Objects of triangles in a scene: effects as the queries of the same name, sweeps and responses replayed by brute
// force.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/scene/scene.h>

#include "scene_worlds.h"
#include "support/meshes.h"
#include "support/verdicts.h"
#include "watched_motion.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::at;
using test::Cloud;
using test::Layout;
using test::Mesh;
using test::Random;
using test::Shelf;
using test::WatchedMotion;

Cloud cloudOf(const Mesh& mesh)
{
  Cloud cloud(mesh.vertices, Layout{Scalar::float64, 0, 0});
  cloud.setTriangles(mesh.corners);
  return cloud;
}

/// The surface of a box about the origin: 12 triangles.
Mesh boxMesh(const Eigen::Vector3d& half)
{
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto corner = [&](double u, double v) {
        Point3 p;
        p[static_cast<std::size_t>(axis)] = side * half[axis];
        p[static_cast<std::size_t>((axis + 1) % 3)] = u * half[(axis + 1) % 3];
        p[static_cast<std::size_t>((axis + 2) % 3)] = v * half[(axis + 2) % 3];
        return p;
      };
      mesh.add(corner(-1, -1), corner(1, -1), corner(1, 1));
      mesh.add(corner(-1, -1), corner(1, 1), corner(-1, 1));
    }
  return mesh;
}

SceneObject objectOf(const std::string& name, std::shared_ptr<SphereHierarchy> hierarchy, const Eigen::Isometry3d& pose)
{
  SceneObject object;
  object.name = name;
  object.parts.push_back({"", std::move(hierarchy), Eigen::Isometry3d::Identity()});
  object.pose = pose;
  return object;
}

SceneOptions optionsOf(double clearance, double tolerance)
{
  SceneOptions options;
  options.clearance = clearance;
  options.tolerance = tolerance;
  return options;
}

TEST(SceneOfTriangles, EffectsAreThoseOfTheQueries)
{
  int colliding = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const test::Scene made = test::anyMeshScene(seed, 30);
    SCOPED_TRACE(made.name);
    if (!(made.clearance < 1e6)) continue;
    const auto a = std::make_shared<SphereHierarchy>(made.a.view()),
               b = std::make_shared<SphereHierarchy>(made.b.view());
    SceneOptions options = optionsOf(made.clearance, 1e-6);
    options.effects.any = options.effects.flags = true;
    options.effects.distance = std::numeric_limits<double>::infinity();
    Scene scene(options);
    scene.add(objectOf("a", a, made.pose_a));
    scene.add(objectOf("b", b, made.pose_b));
    const SceneResult result = scene.query();
    const Placed at_a{*a, made.pose_a}, at_b{*b, made.pose_b};
    FlagsRequest request;
    request.clearance = made.clearance;
    request.flagged = Flagged::both;
    const FlagsResult flags = brute_force::collisionFlags(at_a, at_b, request);
    EXPECT_EQ(result.any.size(), flags.colliding_a > 0 ? 1u : 0u);
    for (const FlaggedPart& part : result.flags) EXPECT_EQ(part.flags, part.object == 0 ? flags.a : flags.b);
    EXPECT_EQ(result.flags.size(), flags.colliding_a > 0 ? 2u : 0u);
    const DistanceResult nearest = brute_force::closestPair(at_a, at_b, {});
    ASSERT_EQ(result.distance.size(), nearest.pair ? 1u : 0u);
    if (nearest.pair) {
      EXPECT_EQ(result.distance[0].distance, nearest.distance);
    }
    colliding += flags.colliding_a > 0;
    if (HasFailure()) return;
  }
  EXPECT_GT(colliding, 15);
}

/// Boxes and clouds of points that fly about each other.
class Flight {
public:
  explicit Flight(std::uint64_t seed) : random_(seed) {}

  Scene scene(const SceneOptions& options)
  {
    Scene scene(options);
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d half(random_.uniform(0.05, 0.5), random_.uniform(0.05, 0.5), random_.uniform(0.0, 0.3));
      std::vector<Point3> points;
      for (int k = 0; k < 40; ++k) points.push_back(random_.point([&] { return random_.uniform(-0.3, 0.3); }));
      const auto shape = i == 1 ? shelf_.add(points) : shelf_.add(cloudOf(boxMesh(half)));
      Eigen::Isometry3d pose = random_.pose(0.0);
      pose.translation() =
          1.2 * Eigen::Vector3d(random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1));
      SceneObject object = objectOf(std::to_string(i), shape, pose);
      object.fixed = i == 3;
      const Eigen::Vector3d turn(random_.uniform(-3, 3), random_.uniform(-3, 3), random_.uniform(-3, 3));
      if (!object.fixed)
        object.motion = VelocityMotion{-1.5 * pose.translation(), random_.chance(0.3) ? Eigen::Vector3d::Zero() : turn};
      scene.add(object);
    }
    return scene;
  }

private:
  Random random_;
  Shelf shelf_;
};

TEST(SceneOfTriangles, NothingCollidesBeforeItsFirstContact)
{
  std::size_t contacts = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Flight flight(seed);
    SceneOptions options = optionsOf(seed % 3 == 0 ? 0.0 : 0.05, seed % 2 == 0 ? 1e-3 : 1e-6);
    options.effects.first_contact = true;
    Scene scene = flight.scene(options);
    scene.query();
    WatchedMotion watch(scene);
    const SceneResult result = scene.step(0.7);
    contacts += result.first_contact.size();
    ASSERT_EQ(watch.replayFirstContacts(result, 150), "");
  }
  EXPECT_GT(contacts, 10u);
}

TEST(SceneOfTriangles, ResponsesLeadThroughNothing)
{
  int touched = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Flight flight(seed + 100);
    SceneOptions options = optionsOf(seed % 3 == 0 ? 0.0 : 0.05, seed % 2 == 0 ? 1e-3 : 1e-5);
    options.effects.response = seed % 4 < 2 ? Response::stop : Response::slide;
    Scene scene = flight.scene(options);
    scene.query();
    for (int step = 0; step < 2; ++step) {
      WatchedMotion watch(scene);
      const SceneResult result = scene.step(0.4);
      for (const Outcome& outcome : result.outcomes) touched += outcome.touched && !outcome.stuck;
      ASSERT_EQ(watch.replayResponses(result, 150), "") << "step " << step;
    }
  }
  EXPECT_GT(touched, 8);
}

TEST(SceneOfTriangles, ABoxSlidesOverAFloorOfTwoTriangles)
{
  Shelf shelf;
  Mesh floor;
  floor.add({-50, -50, 0}, {50, -50, 0}, {50, 50, 0});
  floor.add({-50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  SceneOptions options = optionsOf(0.1, 1e-4);
  options.effects.response = Response::slide;
  Scene scene(options);
  SceneObject ground = objectOf("floor", shelf.add(cloudOf(floor)), Eigen::Isometry3d::Identity());
  ground.fixed = true;
  scene.add(ground);
  SceneObject box = objectOf("box", shelf.add(cloudOf(boxMesh({0.5, 0.3, 0.2}))), at(-5, 1, 0.6));
  box.motion = VelocityMotion{{10, 0.5, -1}, {0, 0, 0}};
  const ObjectId id = scene.add(box);
  scene.query();
  std::uint64_t work = 0;
  for (int step = 0; step < 3; ++step) {
    WatchedMotion watch(scene);
    const SceneResult result = scene.step(0.3);
    EXPECT_EQ(watch.replayResponses(result, 60), "");
    work += result.cost(Effect::slide).work.node_pairs + result.cost(Effect::slide).work.exact_decisions;
  }
  const Eigen::Vector3d place = scene[id].pose.translation();
  EXPECT_NEAR(place.x(), -5 + 9.0, 1e-3) << "no friction, along the floor's plane";
  EXPECT_NEAR(place.y(), 1 + 0.45, 1e-3);
  EXPECT_NEAR(place.z(), 0.2 + 0.1, 2e-4) << "at the clearance above it";
  EXPECT_LT(work, 20000u);
}

TEST(SceneOfTriangles, SweptFlagsAreThoseOfManyInstants)
{
  Shelf shelf;
  SceneOptions options = optionsOf(0.05, 1e-3);
  options.effects.swept = options.effects.first_contact = true;
  Scene scene(options);
  Mesh needle; // passes through a plate's middle
  needle.add({0, 0, -2}, {0, 0, 2}, {0, 0, 2});
  needle.add({3, 3, -2}, {3, 3, 2}, {3, 3, 2}); // passes beside it
  SceneObject mover = objectOf("needles", shelf.add(cloudOf(needle)), at(-4, 0, 0));
  mover.motion = VelocityMotion{{8, 0, 0}, {0, 0, 0}};
  scene.add(mover);
  Mesh plate;
  plate.add({0, -1, -1}, {0, 1, -1}, {0, 0, 1});
  plate.add({0, 2.94, -1}, {0, 2.94, 1}, {0, 2, 0}); // 0.06 from the second needle's way: free
  plate.add({0, 2.96, -1}, {0, 2.96, 1}, {0, 2, 0}); // 0.04
  SceneObject wall = objectOf("plates", shelf.add(cloudOf(plate)), Eigen::Isometry3d::Identity());
  wall.fixed = true;
  scene.add(wall);
  scene.query();
  const SceneResult result = scene.step(1.0);
  ASSERT_EQ(result.swept.size(), 2u);
  EXPECT_EQ(result.swept[0].flags, test::verdictsOf({1, 1}));
  EXPECT_EQ(result.swept[1].flags, test::verdictsOf({1, 0, 1}));
  ASSERT_EQ(result.first_contact.size(), 1u);
  EXPECT_NEAR(result.first_contact[0].fraction, (4 - 3 - 0.03) / 8, 1e-3) << "the second needle comes first";
}

TEST(SceneOfTriangles, FollowTheirVertices)
{
  Mesh mesh = boxMesh({0.5, 0.5, 0.5});
  std::vector<double> vertices;
  for (const Point3& p : mesh.vertices) vertices.insert(vertices.end(), p.begin(), p.end());
  const TrianglesView triangles{viewOf(vertices.data(), mesh.vertices.size()), mesh.corners.data(), 12};
  const auto hierarchy = std::make_shared<SphereHierarchy>(viewOf(triangles));
  Shelf shelf;
  SceneOptions options = optionsOf(0.1, 1e-4);
  options.effects.any = options.effects.flags = true;
  options.effects.deform = 1.5;
  Scene scene(options);
  const ObjectId id = scene.add(objectOf("box", hierarchy, Eigen::Isometry3d::Identity()));
  scene.add(objectOf("point", shelf.add({{2.0, 0.1, 0.2}}), Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(scene.query().any.empty());
  for (std::size_t i = 0; i < vertices.size(); i += 3)
    if (vertices[i] > 0.0) vertices[i] = 1.95; // the box grows
  scene.deform(id, 0, viewOf(triangles));
  const SceneResult result = scene.query();
  ASSERT_EQ(result.any.size(), 1u);
  EXPECT_TRUE(hierarchy->validate().none());
}

} // namespace
} // namespace pcl_bsh
