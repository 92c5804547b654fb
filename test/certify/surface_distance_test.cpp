// SPDX-License-Identifier: BSD-3-Clause
// Verdicts about covered surfaces against CGAL's exact distances from points to triangles.
#include "../surface/meshes.h"

#include <pcl_bsh/collision/collision_flags.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

Kernel::Point_3 exact(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

/// A point within some clearances of a random point of the mesh.
Point3 near(const test::TestMesh& mesh, double reach, test::Random& random)
{
  const Triangle& t =
      mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.triangles.size()) - 1))];
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  Point3 p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]) + random.uniform(-reach, reach);
  return p;
}

/// Free only farther than the clearance, colliding only within clearance + tolerance: of the mesh, in exact arithmetic.
void expectTrueVerdicts(test::TestMesh mesh, std::uint64_t seed)
{
  test::Random random(seed);
  Eigen::Isometry3d frame = random.pose(1.0);
  if (seed % 3 == 0) frame.translation() += Eigen::Vector3d(513449.7, 5402650.2, 300.1);
  mesh.move(frame);
  // CGAL's tree takes none without area; test/surface has those.
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return CGAL::collinear(exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]), exact(mesh.vertices[t[2]]));
  });
  SurfaceRequest request;
  request.tolerance = std::pow(10.0, random.uniform(-2, -0.5));
  request.triangles_apart = seed % 2 == 0;
  const double clearance = random.pick({0.0, 0.5, 3.0}) * request.tolerance;
  const SurfaceCover cover = coverSurface(mesh.view(), mesh.triangles, request);
  std::vector<Point3> scan;
  for (int i = 0; i < 400; ++i) scan.push_back(near(mesh, 1.2 * (clearance + request.tolerance), random));
  const SphereHierarchy surface(cover.view()), points(viewOf(scan[0].data(), scan.size()));
  FlagsRequest question;
  question.clearance = clearance;
  const FlagsResult flags = collisionFlags({points}, {surface}, question);

  Triangles triangles;
  for (const Triangle& t : mesh.triangles) {
    triangles.emplace_back(exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]), exact(mesh.vertices[t[2]]));
  }
  const Tree tree(triangles.begin(), triangles.end());
  const Kernel::FT least = Kernel::FT(clearance) * clearance;
  const Kernel::FT most = CGAL::square(Kernel::FT(clearance) + request.tolerance);
  int close = 0, between = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Kernel::FT squared = tree.squared_distance(exact(scan[i]));
    if (squared <= least) {
      ASSERT_EQ(flags.a[i], 1) << i;
      ++close;
    }
    else if (squared <= most) {
      ++between;
    }
    else {
      ASSERT_EQ(flags.a[i], 0) << i;
    }
  }
  EXPECT_GT(between, 0);
  EXPECT_TRUE(close > 0 || clearance == 0);
}

TEST(SurfaceDistance, OfRandomMeshes)
{
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    expectTrueVerdicts(test::soup(seed, 30, 1.0, 0.5), seed);
  }
}

TEST(SurfaceDistance, OfBoxesSpheresAndWaves)
{
  expectTrueVerdicts(test::boxMesh(1, 0.5, 0.1), 20);
  expectTrueVerdicts(test::boxMesh(1, 1, 0.001), 21);
  expectTrueVerdicts(test::sphereMesh(0.7, 24), 22);
  expectTrueVerdicts(test::gridMesh(40, 30,
                                    [](double u, double v) -> Point3 {
                                      return {u, v, 0.05 * std::sin(20 * u) * std::cos(15 * v)};
                                    }),
                     24);
}

} // namespace
} // namespace pcl_bsh
