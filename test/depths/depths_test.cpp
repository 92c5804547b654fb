// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/depths/depths.h>

#include <pcl_bsh/geometry/rigid_motion.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include "solid/meshes.h"
#include "support/brute_force/depths.h"
#include "support/random.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace pcl_bsh {
namespace {

Eigen::Isometry3d randomPose(test::Random& random, double shift)
{
  Eigen::Vector3d axis;
  for (double& x : axis) x = random.uniform(-1, 1);
  Eigen::Isometry3d pose(Eigen::AngleAxisd(random.uniform(0, 3), axis.normalized()));
  for (int k = 0; k < 3; ++k) pose.translation()[k] = random.uniform(-shift, shift);
  return pose;
}

/// A mesh that closes, as a solid and as a cloud.
struct Tank {
  explicit Tank(const test::ClosedMesh& of) : mesh(of), solid(mesh.view()), surface(viewOf(mesh.view())) {}
  DeepSolid at(const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity()) const { return {solid, surface, pose}; }

  const test::ClosedMesh mesh;
  const Solid solid;
  const SphereHierarchy surface;
};

/// Boxes, one in the other and beside it, and a bumpy ball.
test::ClosedMesh bodies(int kind)
{
  test::ClosedMesh mesh;
  switch (kind) {
  case 0:
    return test::boxMesh();
  case 1:
    return test::bumpyMesh(8, 0.2);
  case 2: // a hollow
    mesh.add(test::boxMesh(), 1.0);
    mesh.add(test::boxMesh(), 0.5, {0.25, 0.25, 0.25}, true);
    return mesh;
  case 3: // nested, and one that overlaps
    mesh.add(test::boxMesh(), 1.0);
    mesh.add(test::boxMesh(), 0.5, {0.25, 0.25, 0.25});
    mesh.add(test::boxMesh(), 0.7, {0.6, 0.1, 0.1});
    return mesh;
  default:
    return test::fanMesh(7);
  }
}

TEST(Depths, OfPointsAndBallsAreThoseOfBruteForce)
{
  test::Random random(1);
  std::size_t deep = 0;
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    const double scale = i % 4 == 1 ? 1e-3 : 1.0, far = i % 4 == 2 ? 5e6 : 0.0;
    test::ClosedMesh mesh;
    mesh.add(bodies(i % 5), scale, {far, -far, 0});
    const Tank tank(mesh);
    std::vector<Point3> points;
    std::vector<float> radii;
    for (int k = 0; k < 200; ++k) {
      Point3 p = {far, -far, 0};
      for (double& x : p) x += scale * (k % 3 == 0 ? random.integer(-1, 5) * 0.25 : random.uniform(-0.3, 1.3));
      points.push_back(p);
      radii.push_back(static_cast<float>(k % 2 == 0 ? 0.0 : scale * random.uniform(0, 0.5)));
    }
    points[7] = {NAN, 0, 0};
    PointsView view = viewOf(points[0].data(), points.size());
    if (i % 2 == 1) view.radii = radii.data();
    const SphereHierarchy cloud(view);
    const QueriedRecords queried(cloud);
    const Eigen::Isometry3d pose = i % 3 == 0 ? randomPose(random, 0.2) : Eigen::Isometry3d::Identity();
    const DepthsResult found = depthsIn(tank.at(pose), queried, pose, 2);
    const DepthsResult expected = brute_force::depthsIn(tank.at(pose), queried, pose);
    ASSERT_EQ(found.depths.size(), expected.depths.size());
    for (std::size_t k = 0; k < found.depths.size(); ++k) {
      const Depth &f = found.depths[k], &e = expected.depths[k];
      EXPECT_EQ(f.record, e.record);
      EXPECT_EQ(f.told, e.told);
      EXPECT_EQ(f.nearest, e.nearest);
      EXPECT_LE(f.depth.lower, f.told);
      EXPECT_GE(f.depth.upper, f.told);
      deep += f.told > 0.0;
    }
  }
  EXPECT_GT(deep, 300u);
}

/// The interval of a triangle agrees with the places of a grid on it.
void expectHeldBetween(const DepthsResult& found, const DepthsResult& grid, double rounding)
{
  std::map<std::uint32_t, Depth> of;
  for (const Depth& depth : found.depths) {
    of[depth.record] = depth;
    EXPECT_LE(0.0, depth.depth.lower);
    EXPECT_LE(depth.depth.lower, depth.told);
    EXPECT_LE(depth.told, depth.depth.upper);
    EXPECT_LE(depth.depth.upper - depth.told, depth.told * kDepthShare + rounding) << depth.record;
  }
  for (const Depth& sampled : grid.depths) {
    const auto at = of.find(sampled.record);
    if (at == of.end()) {
      EXPECT_LE(sampled.depth.lower, 0.0) << sampled.record;
      continue;
    }
    EXPECT_GE(at->second.depth.upper, sampled.depth.lower - rounding) << sampled.record;
    EXPECT_LE(at->second.depth.lower, sampled.depth.upper + rounding) << sampled.record;
  }
}

TEST(Depths, OfTrianglesAreIntervalsThatHoldThoseOfBruteForce)
{
  test::Random random(2);
  std::size_t crossing = 0;
  for (int i = 0; i < 15; ++i) {
    SCOPED_TRACE(i);
    const double scale = i % 4 == 1 ? 1e-3 : 1.0, far = i % 4 == 2 ? 5e6 : 0.0;
    test::ClosedMesh mesh, plates;
    mesh.add(bodies(i % 5), scale, {far, -far, 0});
    const Tank tank(mesh);
    for (int k = 0; k < 8; ++k) {
      const double size = k < 3 ? 4.0 : k < 6 ? 0.4 : 0.05;
      Point3 middle = {far, -far, 0};
      for (double& x : middle) x += scale * random.uniform(0, 1);
      std::array<std::uint32_t, 3> corners;
      for (std::uint32_t& corner : corners)
        corner = plates.vertex(middle[0] + scale * random.uniform(-size, size),
                               middle[1] + scale * random.uniform(-size, size),
                               middle[2] + scale * random.uniform(-size, size));
      plates.triangle(corners[0], corners[1], corners[2]);
    }
    const SphereHierarchy cloud(viewOf(plates.view()));
    const QueriedRecords queried(cloud);
    const Eigen::Isometry3d pose = far > 0.0 ? Eigen::Isometry3d::Identity() : randomPose(random, 0.2);
    const Eigen::Isometry3d moved = pose * Eigen::Translation3d(0.1 * scale, 0, 0);
    const DepthsResult found = depthsIn(tank.at(moved), queried, pose);
    expectHeldBetween(found, brute_force::depthsIn(tank.at(moved), queried, pose, 16), 1e-4 * scale + 1e-12 * far);
    for (const Depth& depth : found.depths) crossing += depth.told > 0.0;
    const DepthsResult deepest = depthsIn(tank.at(moved), queried, pose, 1, true);
    const Depth *const one = deepestOf(found.depths), *const other = deepestOf(deepest.depths);
    ASSERT_EQ(one == nullptr, other == nullptr);
    if (one) {
      EXPECT_LE(other->depth.lower, one->depth.upper);
      EXPECT_GE(other->depth.upper, one->depth.lower);
    }
  }
  EXPECT_GT(crossing, 45u);
}

/// Places of which the depth is known.
TEST(Depths, OfTrianglesInACube)
{
  const Tank tank(test::boxMesh());
  struct Case {
    std::array<Point3, 3> triangle;
    double depth;
    double width = 2e-3; ///< of the interval, for the depth
  };
  const std::vector<Case> cases = {
      {{{{0.2, 0.2, 0.5}, {0.3, 0.2, 0.5}, {0.2, 0.3, 0.5}}}, 0.25},         // all inside
      {{{{0.1, 0.5, 0.5}, {-3, 0.5, 0.5}, {-3, 0.6, 0.5}}}, 0.1},            // a tip
      {{{{-9, -9, 0.9}, {9, -9, 0.9}, {0, 20, 0.9}}}, 0.1},                  // a plate through it, parallel to its top
      {{{{-9, -9, 0.5}, {9, -9, 0.5}, {0, 20, 0.5}}}, 0.5},                  // through its middle
      {{{{-50, 0.5, -50}, {50, 0.5, -50}, {0, 0.5, 90}}}, 0.5},              // a wall
      {{{{0.001, -5, -5}, {0.001, 5, -5}, {0.001, 0.5, 9}}}, 0.001, 20},     // nearly in its face: too many pieces
      {{{{-1, 0.5, 0.5}, {2, 0.5, 0.5}, {2, 0.5, 0.5}}}, 0.5},               // a segment
      {{{{0.25, 0.25, 0.25}, {0.25, 0.25, 0.25}, {0.25, 0.25, 0.25}}}, 0.25} // a point
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    test::ClosedMesh plate;
    for (const Point3& p : cases[i].triangle) plate.vertex(p[0], p[1], p[2]);
    plate.triangle(0, 1, 2);
    const SphereHierarchy cloud(viewOf(plate.view()));
    const DepthsResult found = depthsIn(tank.at(), QueriedRecords(cloud), Eigen::Isometry3d::Identity());
    ASSERT_EQ(found.depths.size(), 1u);
    EXPECT_LE(found.depths[0].depth.lower, cases[i].depth);
    EXPECT_GE(found.depths[0].depth.upper, cases[i].depth);
    EXPECT_NEAR(found.depths[0].told, cases[i].depth, 2e-3 * cases[i].depth);
    EXPECT_LT(found.depths[0].depth.upper - found.depths[0].depth.lower, cases[i].width * cases[i].depth);
    EXPECT_LT(found.work.leaf_pairs, 20000u);
  }
}

TEST(Depths, WhatTouchesFromOutsideIsNotDeep)
{
  const Tank tank(test::boxMesh());
  const std::vector<std::array<Point3, 3>> triangles = {
      {{{0.2, 0.2, 1}, {0.9, 0.3, 1}, {0.3, 0.8, 1}}}, // on the seam between two of its faces
      {{{-4, -4, 1}, {5, -4, 1}, {0, 9, 1}}},          // a table on it
      {{{0.5, 0.1, 1}, {0.5, 0.9, 1}, {0.5, 0.5, 2}}}, // stands on an edge
      {{{0.5, 0.5, 1}, {2, 2, 3}, {-1, 2, 3}}},        // on a corner
      {{{1, -1, 2}, {1, 2, 2}, {1, 0.5, -3}}}};        // along a side
  for (const auto& triangle : triangles) {
    test::ClosedMesh plate;
    for (const Point3& p : triangle) plate.vertex(p[0], p[1], p[2]);
    plate.triangle(0, 1, 2);
    const SphereHierarchy cloud(viewOf(plate.view()));
    const DepthsResult found = depthsIn(tank.at(), QueriedRecords(cloud), Eigen::Isometry3d::Identity());
    ASSERT_EQ(found.depths.size(), 1u);
    EXPECT_EQ(found.depths[0].depth.lower, 0.0);
    EXPECT_EQ(found.depths[0].told, 0.0);
    EXPECT_LT(found.depths[0].depth.upper, 1e-10);
    EXPECT_EQ(deepestOf(found.depths), nullptr);
  }
}

} // namespace
} // namespace pcl_bsh
