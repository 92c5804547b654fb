// SPDX-License-Identifier: BSD-3-Clause
// Verdicts, distances and first poses of triangles against CGAL's exact distances between triangles and points, and
// between triangles.
#include "../surface/meshes.h"
#include "support/verdicts.h"

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/surface/triangle_answers.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Number = Kernel::FT;

Kernel::Point_3 exact(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

std::vector<Kernel::Triangle_3> exact(const test::TestMesh& mesh)
{
  std::vector<Kernel::Triangle_3> triangles;
  for (const Triangle& t : mesh.triangles)
    triangles.emplace_back(exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]), exact(mesh.vertices[t[2]]));
  return triangles;
}

/// Triangles with area, some thin; those of uneven seeds in UTM coordinates.
test::TestMesh triangles(std::uint64_t seed, int count)
{
  test::TestMesh mesh = test::soup(seed, count, 1.0, 0.6);
  if (seed % 2 == 1) {
    Eigen::Isometry3d utm = Eigen::Isometry3d::Identity();
    utm.translation() << 513449.75, 5402650.25, 300.125;
    mesh.move(utm);
  }
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return CGAL::collinear(exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]), exact(mesh.vertices[t[2]]));
  });
  return mesh;
}

SurfaceRequest within(double tolerance, bool apart)
{
  SurfaceRequest request;
  request.tolerance = tolerance;
  request.triangles_apart = apart;
  return request;
}

template <typename Others>
std::vector<Number> squaredDistances(const std::vector<Kernel::Triangle_3>& triangles, const Others& others)
{
  std::vector<Number> least;
  for (const auto& triangle : triangles) {
    Number best = CGAL::squared_distance(triangle, others.front());
    for (const auto& other : others) best = std::min(best, Number(CGAL::squared_distance(triangle, other)));
    least.push_back(best);
  }
  return least;
}

struct Counts {
  int colliding = 0, between = 0, free = 0;
};

/// Verdicts and distances of triangles at one pose against the squares of the true distances.
/// @param slack the sum of tolerances
Counts expectTrue(const SurfaceCover& cover, const SphereHierarchy& other, double clearance, double slack,
                  const std::vector<Number>& squared)
{
  const SphereHierarchy balls(cover.view());
  FlagsRequest question;
  question.clearance = clearance;
  const auto verdicts = triangleVerdicts(cover, collisionFlags({balls}, {other}, question).a);
  const std::vector<double> distances = pointDistances({balls}, {other}).distance;
  const auto least = ofBalls(nearestBalls(cover, distances), distances, 0.0);
  Counts counts;
  for (std::size_t t = 0; t < squared.size(); ++t) {
    if (squared[t] <= CGAL::square(Number(clearance))) {
      EXPECT_EQ(verdicts[t], Verdict::colliding) << t;
      ++counts.colliding;
    }
    else if (squared[t] <= CGAL::square(Number(clearance) + slack)) {
      ++counts.between;
    }
    else {
      EXPECT_EQ(verdicts[t], Verdict::free) << t;
      ++counts.free;
    }
    // The distance was rounded to a double.
    const Number lower = std::nextafter(least[t], -1e300), upper = Number(std::nextafter(least[t], 1e300)) + slack;
    if (lower > 0) {
      EXPECT_GE(squared[t], CGAL::square(lower)) << t;
    }
    EXPECT_GE(upper, 0) << t;
    EXPECT_LE(squared[t], CGAL::square(upper)) << t;
  }
  return counts;
}

void expectAll(const Counts& counts)
{
  EXPECT_GT(counts.colliding, 0);
  EXPECT_GT(counts.between, 0);
  EXPECT_GT(counts.free, 0);
}

TEST(TriangleAnswers, AreTrueOfTrianglesAndPoints)
{
  Counts counts;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(100 + seed);
    const test::TestMesh part = triangles(seed, 40), around = triangles(seed + 50 * 2, 12);
    const SurfaceCover cover = coverSurface(part.view(), part.triangles, within(random.uniform(0.03, 0.2), true));
    const SphereHierarchy scan(around.view());
    std::vector<Kernel::Point_3> points;
    for (const Point3& p : around.vertices) points.push_back(exact(p));
    const Counts found =
        expectTrue(cover, scan, random.pick({0.0, 0.05, 0.2}), cover.tolerance, squaredDistances(exact(part), points));
    counts.colliding += found.colliding, counts.between += found.between, counts.free += found.free;
  }
  expectAll(counts);
}

TEST(TriangleAnswers, AreTrueOfTwoSurfaces)
{
  Counts counts;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(200 + seed);
    const test::TestMesh part = triangles(seed, 24), around = triangles(seed + 50 * 2, 8);
    const SurfaceCover cover = coverSurface(part.view(), part.triangles, within(random.uniform(0.03, 0.2), true));
    const SurfaceCover other = coverSurface(around.view(), around.triangles, within(random.uniform(0.03, 0.2), false));
    const Counts found = expectTrue(cover, SphereHierarchy(other.view()), random.pick({0.0, 0.05, 0.2}),
                                    cover.tolerance + other.tolerance, squaredDistances(exact(part), exact(around)));
    counts.colliding += found.colliding, counts.between += found.between, counts.free += found.free;
  }
  expectAll(counts);
}

TEST(TriangleAnswers, AreTrueAlongAPath)
{
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const test::TestMesh part = triangles(2 * seed, 30);
    const test::TestMesh tool = triangles(2 * seed + 20, 2);
    const SurfaceCover cover = coverSurface(part.view(), part.triangles, within(0.05, true));
    std::vector<Eigen::Isometry3d> poses;
    std::vector<std::vector<Number>> squared; // of each pose
    for (int k = 0; k < 6; ++k) {
      poses.push_back(Eigen::Isometry3d::Identity());
      poses.back().translation().x() = 0.25 * (k - 3); // exact
      std::vector<Kernel::Point_3> points;
      for (const Point3& p : tool.vertices)
        points.emplace_back(Number(p[0]) + Number(poses.back().translation().x()), Number(p[1]), Number(p[2]));
      squared.push_back(squaredDistances(exact(part), points));
    }
    TrajectoryRequest request;
    request.clearance = 0.125;
    request.distances = request.first_poses = request.closest_poses = true;
    const TrajectoryResult run =
        collideAlong({SphereHierarchy(cover.view())}, SphereHierarchy(tool.view()), poses, request);
    const auto verdicts = triangleVerdicts(cover, run.flags);
    const auto first = triangleFirstPoses(cover, run.first_pose);
    const auto nearest = nearestBalls(cover, run.distance, run.closest_pose);
    const auto closest = ofBalls(nearest, run.closest_pose, -1);
    const Number within = CGAL::square(Number(request.clearance)),
                 beyond = CGAL::square(Number(request.clearance) + cover.tolerance);
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
      EXPECT_EQ(verdicts[t] == Verdict::colliding, first[t] >= 0) << t;
      EXPECT_EQ(verdicts[t] == Verdict::colliding, closest[t] >= 0) << t;
      std::size_t best = 0;
      for (std::size_t k = 0; k < poses.size(); ++k) {
        if (squared[k][t] < squared[best][t]) best = k;
        const bool before = first[t] < 0 || static_cast<int>(k) < first[t];
        if (squared[k][t] <= within) {
          EXPECT_FALSE(before) << t << " at " << k;
        }
        if (static_cast<int>(k) == first[t]) {
          EXPECT_LE(squared[k][t], beyond) << t;
        }
      }
      if (closest[t] < 0) continue;
      // At the closest pose the triangle is at most the tolerance farther than at the best of all.
      const double there = std::sqrt(CGAL::to_double(squared[static_cast<std::size_t>(closest[t])][t]));
      EXPECT_LE(there, std::sqrt(CGAL::to_double(squared[best][t])) + cover.tolerance + 1e-6) << t;
    }
  }
}

} // namespace
} // namespace pcl_bsh
