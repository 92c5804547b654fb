// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/columns.h>

#include "meshes.h"

#include <gtest/gtest.h>

#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;

/// Large, small and tiny ones, some flat across an axis, some segments or points.
test::ClosedMesh someTriangles(Random& random, double size)
{
  constexpr double shares[] = {1.0, 0.1, 1e-6};
  test::ClosedMesh mesh;
  const int count = random.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    const double own = size * random.pick(shares);
    std::uint32_t corner[3];
    Point3 first = {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
    if (random.chance(0.3)) first[static_cast<std::size_t>(random.integer(0, 2))] = 0.0;
    for (int k = 0; k < 3; ++k) {
      Point3 p = first;
      for (double& x : p)
        if (random.chance(0.8)) x += random.uniform(-own, own);
      corner[k] = mesh.vertex(p[0], p[1], p[2]);
    }
    mesh.triangle(corner[0], corner[1], corner[2]);
  }
  return mesh;
}

/// A place on one of the triangles, as seen.
Point3 placeOn(const Columns& columns, const TrianglesView& view, Random& random)
{
  const auto i = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(view.count) - 1));
  const Triangle3 t = columns.seenTriangle(i);
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (random.chance(0.3)) u = random.integer(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  Point3 p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = t[0][k] + u * (t[1][k] - t[0][k]) + v * (t[2][k] - t[0][k]);
  return p;
}

TEST(Columns, NoPlaceOnTheSurfaceIsClear)
{
  constexpr double sizes[] = {1.0, 1e-3, 1e9, 1e300, 1e-300};
  Random random(1);
  for (int trial = 0; trial < 400; ++trial) {
    const test::ClosedMesh mesh = someTriangles(random, random.pick(sizes));
    const Columns columns(mesh.view());
    for (int i = 0; i < 400; ++i) ASSERT_FALSE(columns.isClear(placeOn(columns, mesh.view(), random), 0.0)) << trial;
  }
}

TEST(Columns, IsClearThreeCubesBesideASlantingTriangle)
{
  test::ClosedMesh mesh;
  mesh.triangle(mesh.vertex(0, 0, 0), mesh.vertex(64, 0, 64), mesh.vertex(0, 64, 64)); // z = x + y, in cubes
  const Columns columns(mesh.view());
  Random random(2);
  int clear = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(0, 64), y = random.uniform(0, 64 - x);
    for (const double aside : {-4.0, 4.0}) {
      Point3 q = {x, y, x + y};
      q[static_cast<std::size_t>(random.integer(0, 2))] += aside;
      const bool outside = q[0] < 0 || q[1] < 0 || q[2] < 0 || q[0] > 64 || q[1] > 64 || q[2] > 64;
      if (outside) continue; // the outermost cubes stand for what lies beyond
      ++clear;
      ASSERT_TRUE(columns.isClear(columns.seen(q), 0.0)) << q[0] << ' ' << q[1] << ' ' << q[2];
    }
  }
  EXPECT_GT(clear, 2000);
}

} // namespace
} // namespace pcl_bsh
