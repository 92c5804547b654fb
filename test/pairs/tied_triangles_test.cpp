// SPDX-License-Identifier: BSD-3-Clause
// Closest pairs of surfaces of which all triangles are equally near: bounds cannot tell them apart, and the answer is
// the pair with the smallest numbers.
#include <pcl_bsh/collide.h>
#include <pcl_bsh/roadmap/brute_force.h>

#include "support/made_meshes.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::TestMesh;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

void append(TestMesh& mesh, TestMesh other)
{
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (Triangle t : other.triangles) {
    for (std::uint32_t& corner : t) corner += first;
    mesh.triangles.push_back(t);
  }
}

void shuffle(TestMesh& mesh, std::uint64_t seed)
{
  std::mt19937_64 order(seed);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), order);
}

/// Needles about a tip at `at`; the circle where they end is `height` above it and turned a little.
TestMesh cone(std::uint32_t sides, double radius, double height, const Point3& at, double turn = 0.0)
{
  TestMesh mesh = test::fanMesh(sides, radius, 0.0, false);
  mesh.move(Eigen::Translation3d(at[0], at[1], at[2] + height) *
            Eigen::Isometry3d(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())));
  mesh.vertices[0] = at;
  return mesh;
}

/// A cone whose triangles are in rings about its tip, in any order.
TestMesh ringedCone(std::uint32_t sides, double radius, double height, const Point3& at, std::uint64_t seed)
{
  TestMesh mesh = cone(sides, radius, height, at);
  append(mesh, test::gridMesh(sides, 3, [&](double u, double v) -> Point3 {
           const double turn = 2 * std::numbers::pi * u;
           return {at[0] + (1 + v) * radius * std::cos(turn), at[1] + (1 + v) * radius * std::sin(turn),
                   at[2] + (1 + v) * height};
         }));
  shuffle(mesh, seed);
  return mesh;
}

struct Pair {
  TestMesh a, b;
  Eigen::Isometry3d pose_a = identity, pose_b = identity;
};

/// What all of one is tied with all of the other in, mostly: tips, discs, sheets, and some of it spoilt.
Pair anyTies(std::uint64_t seed)
{
  Random random(seed);
  const double gap = random.pick({0.0, 0.25, 0.3, 1e-3});
  const double heights[] = {0.0, 0.125, 0.5, 3.0};
  const auto part = [&](double up, double at) {
    const auto sides = static_cast<std::uint32_t>(random.integer(3, 40));
    const double height = up * random.pick(heights), radius = random.pick({0.5, 1.0, 2.0});
    const Point3 tip = {random.pick({0.0, 0.0, 0.0, 0.1, 0.5}), 0.0, at};
    if (random.chance(0.2)) return ringedCone(sides, radius, height, tip, seed);
    if (random.chance(0.2))
      return test::gridMesh(4, 4, [&](double u, double v) -> Point3 { return {2 * u - 1, 2 * v - 1, at}; });
    return cone(sides, radius, height, tip, random.uniform(0, 1));
  };
  Pair pair{part(-1.0, 0.0), part(1.0, gap)};
  if (random.chance(0.3)) append(pair.a, part(-1.0, 0.0)); // a second tip, as near as the first or not
  if (random.chance(0.3)) append(pair.b, part(1.0, gap));
  if (random.chance(0.2)) { // so that no plane is between the two
    append(pair.a, cone(7, 1, -1, {50, 0, 5}));
    append(pair.b, cone(7, 1, 1, {50, 0, -5}));
  }
  shuffle(pair.a, seed), shuffle(pair.b, seed + 1);
  Eigen::Isometry3d quarter = identity;
  quarter.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  quarter.translation() << 1, -2, 0.5;
  switch (random.integer(0, 3)) {
  case 0:
    break;
  case 1:
    pair.pose_a = pair.pose_b = quarter;
    break;
  case 2:
    pair.pose_a = pair.pose_b = random.pose(3);
    break;
  default: // the same place in other coordinates, up to rounding
    pair.pose_b = random.pose(3);
    pair.b.move(pair.pose_b.inverse());
  }
  return pair;
}

void expectAsBruteForce(const Placed& a, const Placed& b)
{
  const DistanceResult expected = brute_force::closestPair(a, b);
  for (const unsigned threads : {1u, 2u}) {
    DistanceRequest request;
    request.threads = threads;
    const DistanceResult found = closestPair(a, b, request);
    ASSERT_EQ(found.distance, expected.distance);
    ASSERT_EQ(found.pair->a, expected.pair->a);
    ASSERT_EQ(found.pair->b, expected.pair->b);
    ASSERT_LE(found.interval.lower, found.distance);
    ASSERT_GE(found.interval.upper, found.distance);
    ASSERT_LE(found.interval.upper - found.interval.lower, 1e-12);
  }
  DistanceRequest roughly;
  roughly.accuracy = Accuracy::tolerance(1e-13);
  const DistanceResult near = closestPair(a, b, roughly);
  ASSERT_LE(near.distance, expected.distance + 1e-13);
}

TEST(TiedTriangles, AnswerAsBruteForce)
{
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    const Pair pair = anyTies(seed);
    const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
    expectAsBruteForce({a, pair.pose_a}, {b, pair.pose_b});
  }
}

TEST(TiedTriangles, AnswerAsBruteForceBesidePoints)
{
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(seed);
    const Pair pair = anyTies(seed);
    const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
    std::vector<Point3> corners; // tips are there many times
    for (const Triangle& t : pair.b.triangles)
      for (const std::uint32_t corner : t) corners.push_back(pair.b.vertices[corner]);
    std::vector<float> radii(corners.size());
    Random random(seed);
    for (float& radius : radii) radius = static_cast<float>(random.pick({0.0, 0.0625, 0.125}));
    PointsView view = viewOf(corners[0].data(), corners.size());
    for (const float* own : {static_cast<const float*>(nullptr), static_cast<const float*>(radii.data())}) {
      view.radii = own;
      const SphereHierarchy points(view);
      expectAsBruteForce({a, pair.pose_a}, {points, pair.pose_b});
      expectAsBruteForce({points, pair.pose_b}, {a, pair.pose_a});
    }
  }
}

struct Tied {
  const char* name;
  std::function<Pair(std::uint32_t)> make;
};

const std::vector<Tied>& tied()
{
  static const std::vector<Tied> all = {
      {"cones tip to tip",
       [](std::uint32_t n) {
         return Pair{cone(n, 1, -1, {0, 0, 0}), cone(n, 1, 1, {0, 0, 0.3}, 0.1)};
       }},
      {"discs that face each other",
       [](std::uint32_t n) {
         return Pair{cone(n, 1, 0, {0, 0, 0}), cone(n, 1, 0, {0, 0, 0.3}, 0.1)};
       }},
      {"cones of rings",
       [](std::uint32_t n) {
         return Pair{ringedCone(n, 0.2, -0.2, {0, 0, 0}, 1), ringedCone(n, 0.2, 0.2, {0, 0, 0.3}, 2)};
       }},
      {"a disc below a cone",
       [](std::uint32_t n) {
         return Pair{cone(n, 1, 0, {0, 0, 0}), cone(n, 1, 1, {0.5, 0, 0.3})};
       }},
      {"a cone below a disc",
       [](std::uint32_t n) {
         return Pair{cone(n, 1, -1, {0.5, 0, 0}), cone(n, 1, 0, {0, 0, 0.3})};
       }},
      {"cones, no plane between all of them", [](std::uint32_t n) {
         Pair pair{cone(n, 1, -1, {0, 0, 0}), cone(n, 1, 1, {0, 0, 0.3}, 0.1)};
         append(pair.a, cone(n, 1, 1, {9, 0, 2.5}));
         append(pair.b, cone(n, 1, -1, {9, 0, 1.5}));
         shuffle(pair.a, 1), shuffle(pair.b, 2);
         return pair;
       }}};
  return all;
}

/// All pairs would be n / 2 decisions a triangle, and more.
TEST(TiedTriangles, TakeWorkInProportion)
{
  const Eigen::Isometry3d turned = Random(1).pose(3);
  for (const Tied& tied : tied())
    for (const Eigen::Isometry3d& pose : {identity, turned})
      for (const std::uint32_t n : {1000u, 4000u, 16000u}) {
        const Pair pair = tied.make(n);
        const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
        const Work work = closestPair({a, pose}, {b, pose}).work;
        const std::size_t triangles = pair.a.triangles.size() + pair.b.triangles.size();
        EXPECT_LE(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions, 40 * triangles)
            << tied.name << ", " << n;
      }
}

} // namespace
} // namespace pcl_bsh
