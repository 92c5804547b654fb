// SPDX-License-Identifier: BSD-3-Clause
// The Hausdorff distance of surfaces: known ones, and intervals against the distances of many places.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/distances/point_distances.h>

#include "support/made_meshes.h"
#include "support/random.h"
#include "support/tied_meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::TestMesh;

/// A mesh, and its hierarchy.
struct Surface {
  explicit Surface(TestMesh made) : mesh(std::move(made)), hierarchy(viewOf(mesh.trianglesView())) {}
  operator Placed() const { return {hierarchy}; }

  const TestMesh mesh;
  const SphereHierarchy hierarchy;
};

TestMesh squareMesh(double side, double z = 0.0)
{
  TestMesh mesh;
  mesh.add({0, 0, z}, {side, 0, z}, {side, side, z});
  mesh.add({0, 0, z}, {side, side, z}, {0, side, z});
  return mesh;
}

/// Over the square, with its top above the middle.
TestMesh tentMesh(double side, double height)
{
  const Point3 top{side / 2, side / 2, height}, corner[4] = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
  TestMesh mesh;
  for (std::size_t k = 0; k < 4; ++k) mesh.add(corner[k], corner[(k + 1) % 4], top);
  return mesh;
}

TestMesh cubeMesh(double side, const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity())
{
  TestMesh mesh;
  const auto at = [&](int i) -> Point3 { return {side * (i & 1), side * (i >> 1 & 1), side * (i >> 2 & 1)}; };
  const int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& f : faces) mesh.add(at(f[0]), at(f[1]), at(f[2])), mesh.add(at(f[0]), at(f[2]), at(f[3]));
  mesh.move(pose);
  return mesh;
}

TestMesh ballMesh(std::uint32_t rings, double radius)
{
  return test::gridMesh(2 * rings, rings, [&](double u, double v) -> Point3 {
    const double turn = 2 * std::numbers::pi * u, up = std::numbers::pi * (v - 0.5);
    return {radius * std::cos(up) * std::cos(turn), radius * std::cos(up) * std::sin(turn), radius * std::sin(up)};
  });
}

TestMesh scaled(TestMesh mesh, double factor, const Point3& shift = {0, 0, 0})
{
  for (Point3& p : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) p[k] = factor * p[k] + shift[k];
  return mesh;
}

/// @param slack how far the truth may be outside, for it is rounded
void expectHolds(const HausdorffDistance& found, double truth, double tolerance, double slack = 0.0)
{
  EXPECT_LE(found.interval.lower, truth + slack);
  EXPECT_GE(found.interval.upper, truth - slack);
  EXPECT_LE(found.interval.upper - found.interval.lower, tolerance * (1.0 + 1e-9) + slack);
  EXPECT_LE(found.interval.lower, found.distance);
  EXPECT_GE(found.interval.upper, found.distance);
  EXPECT_TRUE(found.pair);
}

TEST(SurfaceHausdorff, OfATentIsItsHeight)
{
  for (const double height : {1.0, 0.25, 7.0}) {
    const Surface tent(tentMesh(4, height)), base(squareMesh(4));
    const HausdorffDistance found = hausdorffDistance(tent, base);
    EXPECT_EQ(found.distance, height);
    expectHolds(found, height, kHausdorffShare * 10);
    EXPECT_EQ(hausdorffDistance(base, tent).distance, height);
    EXPECT_EQ(hausdorffDistance(base, tent).pair->b, found.pair->a);
    const SymmetricDistances both = symmetricDistances(tent, base);
    EXPECT_EQ(both.hausdorff, height);
    EXPECT_EQ(both.hausdorff_pair, found.pair);
    EXPECT_EQ(both.hausdorff_interval.lower, found.interval.lower);
    EXPECT_EQ(both.hausdorff_interval.upper, found.interval.upper);
    EXPECT_EQ(both.a.greatest, 0.0) << "the records touch";
  }
}

TEST(SurfaceHausdorff, OfAPointAndATriangleIsThatOfTheFarthestCorner)
{
  TestMesh mesh;
  mesh.add({0, 0, 0}, {10, 0, 0}, {0, 10, 0});
  const Surface triangle(mesh);
  const double place[3] = {0, 0, 0};
  const SphereHierarchy point(viewOf(place, 1));
  for (const HausdorffDistance& found : {hausdorffDistance(triangle, point), hausdorffDistance(point, triangle)}) {
    EXPECT_EQ(found.distance, 10.0);
    expectHolds(found, 10.0, 1e-12);
    EXPECT_EQ(found.pair, (PointPair{0, 0}));
  }
  EXPECT_EQ(symmetricDistances(point, triangle).hausdorff, 10.0);
}

/// The distance of points, and that of balls, is exact.
TEST(SurfaceHausdorff, OfPointsIsExact)
{
  const double one[6] = {0, 0, 0, 1, 0, 0}, other[3] = {0, 0, 0.1};
  const HausdorffDistance found = hausdorffDistance(SphereHierarchy(viewOf(one, 2)), SphereHierarchy(viewOf(other, 1)));
  EXPECT_EQ(found.interval.lower, found.distance);
  EXPECT_EQ(found.interval.upper, found.distance);
  HausdorffRequest request(Accuracy::tolerance(0.5));
  EXPECT_EQ(hausdorffDistance(SphereHierarchy(viewOf(one, 2)), SphereHierarchy(viewOf(other, 1)), request).distance,
            found.distance);
  request.accuracy = Accuracy::level(2);
  EXPECT_THROW(hausdorffDistance(SphereHierarchy(viewOf(one, 2)), SphereHierarchy(viewOf(other, 1)), request),
               InvalidInput);
}

TEST(SurfaceHausdorff, OfKnownShapes)
{
  struct Known {
    const char* name;
    TestMesh a, b;
    double distance;
  };
  const double turn = std::numbers::pi / 4, root = std::sqrt(2.0);
  const Eigen::Isometry3d turned = Eigen::Translation3d(0.5, 0.5, 0) *
                                   Eigen::Isometry3d(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())) *
                                   Eigen::Translation3d(-0.5, -0.5, 0);
  const Eigen::Isometry3d moved(Eigen::Translation3d(3, 0, 0));
  TestMesh fold = squareMesh(1), inner = squareMesh(1);
  fold.add({0, 0, 0}, {1, 1, 0}, {0, 0, 0}); // a segment on it
  inner = scaled(inner, 0.5, {0.25, 0.25, 0.0});
  TestMesh grid = test::gridMesh(7, 5, [](double u, double v) -> Point3 { return {u, v, 0.125}; });
  const std::vector<Known> all = {
      {"offset planes", squareMesh(2), squareMesh(2, 0.75), 0.75},
      {"planes cut otherwise", squareMesh(1), grid, 0.125},
      {"the same plane, cut otherwise", squareMesh(1), scaled(grid, 1.0, {0, 0, -0.125}), 0.0},
      {"a part of a square: from its border", squareMesh(1), inner, 0.25 * root},
      {"degenerate", fold, squareMesh(1, 0.5), 0.5},
      {"a cube and itself", cubeMesh(1), cubeMesh(1), 0.0},
      {"a cube turned by an eighth: its edges", cubeMesh(1), cubeMesh(1, turned), 0.5 * root - 0.5},
      {"a cube moved by three", cubeMesh(1), cubeMesh(1, moved), 3.0},
  };
  for (const Known& known : all) {
    SCOPED_TRACE(known.name);
    const Surface a(known.a), b(known.b);
    expectHolds(hausdorffDistance(a, b), known.distance, kHausdorffShare * 6, 1e-12);
    expectHolds(hausdorffDistance(b, a), known.distance, kHausdorffShare * 6, 1e-12);
    const HausdorffDistance fine = hausdorffDistance(a, b, HausdorffRequest(Accuracy::tolerance(1e-9)));
    expectHolds(fine, known.distance, 1e-9, 1e-12);
  }
}

/// A square that turns about its middle: its corners are the farthest from the other's sides.
TEST(SurfaceHausdorff, OfATurnedSquare)
{
  Random random(5);
  for (int round = 0; round < 12; ++round) {
    const double angle = random.uniform(0.05, 0.75), side = 2.0, off = random.uniform(0, 0.5);
    TestMesh one = scaled(squareMesh(side), 1.0, {-side / 2, -side / 2, 0}), other = one;
    other.move(Eigen::Translation3d(0, 0, off) * Eigen::Isometry3d(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())));
    const double half = side / 2, corner = half * std::numbers::sqrt2 * std::cos(std::numbers::pi / 4 - angle) - half;
    const double truth = std::hypot(corner, off);
    expectHolds(hausdorffDistance(Surface(one), Surface(other)), truth, kHausdorffShare * 4, 1e-12);
  }
}

/// A ball within a ball: each place is as far away as the others, except for their facets.
TEST(SurfaceHausdorff, OfBallsHoldsTheTruth)
{
  const double facet = 1.0 - std::cos(std::numbers::pi / 24);
  const HausdorffDistance found = hausdorffDistance(Surface(ballMesh(12, 1.0)), Surface(ballMesh(12, 1.5)));
  EXPECT_GE(found.interval.upper, 0.5 - 1e-12);
  EXPECT_LE(found.interval.lower, 0.5 + 3 * facet);
  EXPECT_LE(found.interval.upper - found.interval.lower, kHausdorffShare * 6);
}

/// Units as small as 1e-60 and as large as 1e30, and offsets of maps.
TEST(SurfaceHausdorff, OfAnyUnitAndFarFromTheOrigin)
{
  for (const double unit : {1e-60, 1e-30, 1e-6, 1e6, 1e30}) {
    SCOPED_TRACE(unit);
    const HausdorffDistance found =
        hausdorffDistance(Surface(scaled(tentMesh(4, 1), unit)), Surface(scaled(squareMesh(4), unit)));
    expectHolds(found, unit, kHausdorffShare * 6 * unit, 1e-12 * unit);
  }
  const Point3 map{448'000.25, 5'411'000.5, 350.0};
  const HausdorffDistance found =
      hausdorffDistance(Surface(scaled(tentMesh(4, 1), 1.0, map)), Surface(scaled(squareMesh(4), 1.0, map)));
  EXPECT_EQ(found.distance, 1.0);
  const Eigen::Isometry3d pose(Eigen::Translation3d(map[0], map[1], map[2]));
  const Surface tent(tentMesh(4, 1)), base(squareMesh(4));
  EXPECT_EQ(hausdorffDistance({tent.hierarchy, pose}, {base.hierarchy, pose}).distance, 1.0);
}

/// Many places of each triangle.
double sampled(const TestMesh& mesh, const Placed& other, int parts)
{
  std::vector<Point3> places;
  for (const Triangle& t : mesh.triangles) {
    const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const double u = double(i) / parts, v = double(j) / parts;
        Point3 p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]);
        places.push_back(p);
      }
  }
  return brute_force::pointDistances(SphereHierarchy(viewOf(places[0].data(), places.size())), other).greatest;
}

TEST(SurfaceHausdorff, OfRandomMeshesHoldsWhatPlacesSay)
{
  Random random(6);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const auto soup = [&](int count, double size) {
      TestMesh mesh;
      for (int i = 0; i < count; ++i) {
        const Point3 at = random.point([&] { return random.uniform(-1, 1); });
        const auto beside = [&] {
          const Point3 by = random.point([&] { return size * random.uniform(-1, 1); });
          return Point3{at[0] + by[0], at[1] + by[1], at[2] + by[2]};
        };
        mesh.add(beside(), random.chance(0.1) ? at : beside(), random.chance(0.1) ? at : beside());
      }
      return mesh;
    };
    const TestMesh one = soup(random.integer(1, 8), random.uniform(0.1, 2));
    const TestMesh other = soup(random.integer(1, 8), random.uniform(0.1, 2));
    const Surface a(one), b(other);
    constexpr int parts = 24;
    const double least = std::max(sampled(one, b, parts), sampled(other, a, parts));
    const HausdorffDistance found = hausdorffDistance(a, b, HausdorffRequest(Accuracy::tolerance(1e-4)));
    EXPECT_GE(found.interval.upper, least - 1e-12);
    EXPECT_LE(found.interval.lower, least + 4.0 / parts) << "places are so near each other";
    EXPECT_LE(found.interval.upper - found.interval.lower, 1.0001e-4);
    for (const unsigned threads : {2u, 5u}) {
      const HausdorffDistance again = hausdorffDistance(a, b, HausdorffRequest(Accuracy::tolerance(1e-4), threads));
      EXPECT_EQ(again.distance, found.distance);
      EXPECT_EQ(again.interval.upper, found.interval.upper);
      EXPECT_EQ(again.pair, found.pair);
      EXPECT_EQ(again.work.node_pairs, found.work.node_pairs);
    }
  }
}

/// Where doubles do not tell places apart the interval is what it can be.
TEST(SurfaceHausdorff, EndsWhereAToleranceIsTooSmall)
{
  const Surface a(tentMesh(4, 1)), b(squareMesh(4, 1.0 / 3));
  const HausdorffDistance found = hausdorffDistance(a, b, HausdorffRequest(Accuracy::tolerance(0.0)));
  expectHolds(found, 1.0 - 1.0 / 3, 0.0, 1e-9);
}

/// A scan and its mesh: the mesh goes on where nothing was scanned.
TEST(SurfaceHausdorff, OfAScanAndAMesh)
{
  std::vector<Point3> scan;
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) scan.push_back({0.05 * i, 0.05 * j, 0.01 * ((i + j) % 2)});
  const SphereHierarchy points(viewOf(scan[0].data(), scan.size()));
  const Surface mesh(squareMesh(3));
  const SymmetricDistances both = symmetricDistances(points, mesh);
  EXPECT_EQ(both.a.greatest, 0.01);
  EXPECT_NEAR(both.hausdorff, std::numbers::sqrt2, 1e-3);
  EXPECT_EQ(both.hausdorff, hausdorffDistance(points, mesh).distance);
  PointDistancesRequest limited;
  limited.max_distance = 0.005;
  EXPECT_TRUE(std::isnan(symmetricDistances(points, mesh, limited).hausdorff));
  EXPECT_TRUE(std::isnan(symmetricDistances(points, mesh, limited).hausdorff_interval.upper));
}

TEST(SurfaceHausdorff, IsStopped)
{
  const Surface a(ballMesh(40, 1.0)), b(ballMesh(41, 1.25));
  HausdorffRequest request;
  int asked = 0;
  request.progress = [&](double) { return ++asked < 5; };
  EXPECT_THROW(hausdorffDistance(a, b, request), Cancelled);
  EXPECT_EQ(asked, 5);
}

} // namespace
} // namespace pcl_bsh
