// SPDX-License-Identifier: BSD-3-Clause
// Triangles that are as long as all of their mesh, where spheres of nodes tell nothing: flags are those of brute force,
// and their work grows with the triangles.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/pairs/closest_pair.h>

#include "support/made_meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::TestMesh;

const Point3 kNear = {0, 0, 0}, kFar = {691234.125, 5335678.5, 512.25}; // the latter of a grid of maps

/// A kind of mesh of so many long triangles, within 1 or so.
using Make = TestMesh (*)(std::uint32_t);

/// Needles that share corners on an axis.
TestMesh fan(std::uint32_t count)
{
  return test::fanMesh(count / 2, 1.0, 0.3, true);
}

/// Strips side by side, from one side of a sheet to the other.
TestMesh strips(std::uint32_t count)
{
  return test::gridMesh(count / 2, 1, [](double u, double v) -> Point3 { return {u, v, 0.1 * std::sin(5 * u)}; });
}

/// Needles from anywhere to anywhere.
TestMesh needles(std::uint32_t count)
{
  Random random(7);
  TestMesh mesh;
  const auto anywhere = [&] { return random.point([&] { return random.uniform(-1, 1); }); };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Point3 p = anywhere();
    mesh.add(p, {p[0], p[1] + 1e-6, p[2]}, anywhere());
  }
  return mesh;
}

TestMesh moved(TestMesh mesh, const Point3& by)
{
  for (Point3& p : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) p[k] += by[k];
  return mesh;
}

TestMesh scanAbout(std::size_t count, const Point3& middle)
{
  Random random(5);
  TestMesh scan;
  for (std::size_t i = 0; i < count; ++i)
    scan.vertices.push_back({middle[0] + random.uniform(-1.2, 1.2), middle[1] + random.uniform(-1.2, 1.2),
                             middle[2] + random.uniform(-0.5, 0.5)});
  return scan;
}

Eigen::Isometry3d shifted(const Eigen::Vector3d& by)
{
  return Eigen::Isometry3d(Eigen::Translation3d(by));
}

FlagsRequest bothWithin(double clearance)
{
  return {clearance, Flagged::both};
}

TEST(LongTriangles, HaveTheFlagsOfBruteForce)
{
  std::size_t colliding = 0, free = 0;
  for (const Make make : {fan, strips, needles})
    for (const Point3& at : {kNear, kFar})
      for (const bool turned : {false, true}) {
        const TestMesh mesh = moved(make(900), at), scan = scanAbout(200, at);
        const SphereHierarchy points(scan.view());
        Eigen::Isometry3d pose = shifted({0.03, 0.02, 0.05});
        if (turned) {
          const Eigen::Vector3d middle(at[0], at[1], at[2]);
          pose = Eigen::Translation3d(middle) * Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()) *
                 Eigen::Translation3d(-middle);
        }
        const SphereHierarchy fresh(viewOf(mesh.trianglesView())), known(viewOf(mesh.trianglesView()));
        closestPair({known}, {known, shifted({0, 0, 3})}); // fits slabs
        for (const bool of_points : {true, false})
          for (const double clearance : {0.0, 0.004, 0.05}) {
            const auto request = bothWithin(clearance);
            const FlagsResult expected =
                brute_force::collisionFlags({of_points ? points : fresh, pose}, {fresh}, request);
            for (const SphereHierarchy* triangles : {&fresh, &known}) {
              const FlagsResult found = collisionFlags({of_points ? points : *triangles, pose}, {*triangles}, request);
              ASSERT_EQ(found.a, expected.a) << clearance;
              ASSERT_EQ(found.b, expected.b) << clearance;
            }
            colliding += expected.colliding_a + expected.colliding_b;
            free += expected.a.size() + expected.b.size() - expected.colliding_a - expected.colliding_b;
          }
      }
  EXPECT_GT(colliding, 5000u);
  EXPECT_GT(free, 5000u);
}

TEST(LongTriangles, OfUncertainPlacesHaveTheFlagsOfBruteForce)
{
  const TestMesh mesh = fan(900), scan = scanAbout(200, kNear);
  PointsView of_scan = scan.view();
  of_scan.uncertainty = 0.01;
  const SphereHierarchy points(of_scan), triangles(viewOf(mesh.trianglesView()));
  const FlagsResult expected = brute_force::collisionFlags({points}, {triangles}, bothWithin(0.03)),
                    found = collisionFlags({points}, {triangles}, bothWithin(0.03));
  EXPECT_EQ(found.a, expected.a);
  EXPECT_EQ(found.b, expected.b);
  EXPECT_GT(found.undecided_a, 0u);
}

double stepsOf(const Work& work)
{
  return static_cast<double>(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions + work.volumes_built);
}

/// Linear work has 4.
TEST(LongTriangles, TakeWorkThatGrowsWithThem)
{
  struct Question {
    const char* name;
    Work (*ask)(const SphereHierarchy&, const SphereHierarchy&, const Point3&);
  };
  const Question questions[] = {
      {"points",
       [](const SphereHierarchy& mesh, const SphereHierarchy& scan, const Point3&) {
         return collisionFlags({scan}, {mesh}, {0.01, Flagged::a}).work;
       }},
      {"near points",
       [](const SphereHierarchy& mesh, const SphereHierarchy& scan, const Point3&) {
         return collisionFlags({scan}, {mesh}, {0.01, Flagged::b}).work;
       }},
      {"a copy that crosses it",
       [](const SphereHierarchy& mesh, const SphereHierarchy&, const Point3&) {
         return collisionFlags({mesh}, {mesh, shifted({0.015, 0.01, 0.05})}, {0.0, Flagged::both}).work;
       }},
      {"a copy beside it", [](const SphereHierarchy& mesh, const SphereHierarchy&, const Point3&) {
         return collisionFlags({mesh}, {mesh, shifted({0.0, 0.0, 0.7})}, {0.01, Flagged::both}).work;
       }}};
  for (const Point3& at : {kNear, kFar})
    for (const Question& question : questions) {
      double before = 0.0;
      for (const std::uint32_t count : {4000u, 16000u, 64000u}) {
        const TestMesh mesh = moved(fan(count), at), scan = scanAbout(1000, at);
        const SphereHierarchy triangles(viewOf(mesh.trianglesView())), points(scan.view());
        const double steps = stepsOf(question.ask(triangles, points, at));
        EXPECT_LT(steps, 60.0 * count) << question.name << ", " << count;
        if (before > 0.0) {
          EXPECT_LT(steps, 5.5 * before + 15.0 * count) << question.name << ", " << count;
        }
        before = steps;
      }
    }
}

/// Points about a flat fan of needles, a third of them within the clearance of hundreds of these.
TEST(LongTriangles, AFewOfManyNeedlesSettleAPoint)
{
  const TestMesh mesh = test::fanMesh(64000, 1.0, 0.0, false);
  TestMesh scan;
  Random random(5);
  for (int i = 0; i < 4000; ++i) {
    const double turn = random.uniform(0.0, 6.28), length = std::sqrt(random.uniform(0.0, 1.0));
    scan.vertices.push_back({length * std::cos(turn), length * std::sin(turn), random.uniform(-0.03, 0.03)});
  }
  const SphereHierarchy triangles(viewOf(mesh.trianglesView())), points(scan.view());
  const FlagsResult found = collisionFlags({points}, {triangles}, {0.01, Flagged::a});
  EXPECT_GT(found.colliding_a, 1200u);
  EXPECT_LT(found.work.leaf_pairs, 7000u);
  EXPECT_LT(found.work.node_pairs, 1300000u);
}

/// For flat sheets that face each other at about the clearance, floats decide no pair.
TEST(LongTriangles, FacingGridsTakeFewExactDecisions)
{
  const auto gridAt = [](double z, double aside) {
    return test::gridMesh(40, 40, [=](double u, double v) -> Point3 { return {u + aside, v + aside, z}; });
  };
  for (const double gap : {0.125, 0.1})
    for (const double aside : {0.0, 1.0 / 160, 0.01}) {
      const TestMesh below = gridAt(0.0, 0.0), above = gridAt(gap, aside);
      const SphereHierarchy a(viewOf(below.trianglesView())), b(viewOf(above.trianglesView()));
      const FlagsResult beyond = collisionFlags({a}, {b}, {std::nextafter(gap, 0.0), Flagged::a}),
                        tied = collisionFlags({a}, {b}, {gap, Flagged::a});
      EXPECT_EQ(beyond.colliding_a, 0u);
      EXPECT_LE(beyond.work.exact_decisions, 2 * below.triangles.size());
      EXPECT_GT(tied.colliding_a, below.triangles.size() * 9 / 10);
      EXPECT_LE(tied.work.exact_decisions, 3 * below.triangles.size());
    }
}

} // namespace
} // namespace pcl_bsh
