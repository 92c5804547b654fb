// SPDX-License-Identifier: BSD-3-Clause
// Triangles that a ray may meet are listed, places that are called clear are clear, and neither costs much.
#include <pcl_bsh/solid/columns.h>

#include <pcl_bsh/geometry/triangle/triangle_distance.h>
#include <pcl_bsh/solid/cells_along.h>

#include "meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
  constexpr double sizes[] = {1.0, 1e-3, 1e9, 1e300, 1e-300, 1e-310};
  Random random(1);
  for (int trial = 0; trial < 480; ++trial) {
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

/// Whether the shadow of a triangle holds a place; false next to its edges.
bool isUnder(const Triangle3& t, const Point3& at)
{
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 &u = t[i], &v = t[(i + 1) % 3];
    const double side = (v[0] - u[0]) * (at[1] - u[1]) - (v[1] - u[1]) * (at[0] - u[0]);
    left += side > 1e-12, right += side < -1e-12;
  }
  return left == 3 || right == 3;
}

struct Found {
  double listed = 0.0; ///< triangles a place, in the mean
  double clear = 0.0;  ///< share of the places that are a sixteenth of the mesh away from it
};

Found look(const test::ClosedMesh& mesh, double error, std::uint64_t seed)
{
  constexpr int kPlaces = 600;
  const Columns columns(mesh.view());
  const auto count = static_cast<std::uint32_t>(mesh.view().count);
  Point3 low = columns.seen({mesh.xyz[0], mesh.xyz[1], mesh.xyz[2]}), high = low;
  for (std::size_t i = 0; i < mesh.xyz.size(); i += 3) {
    const Point3 p = columns.seen({mesh.xyz[i], mesh.xyz[i + 1], mesh.xyz[i + 2]});
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  double widest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) widest = std::max(widest, high[k] - low[k]);
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  const TriangleDistance distance(identity, identity);
  Random random(seed);
  std::vector<std::uint32_t> several;
  Found found;
  double away = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    Point3 at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = low[k] + (high[k] - low[k]) * random.uniform(0, 1);
    const Columns::Range range = columns.above(at, error, several);
    std::vector<std::uint32_t> listed(range.begin(), range.end());
    found.listed += static_cast<double>(listed.size()) / kPlaces;
    std::sort(listed.begin(), listed.end());
    EXPECT_EQ(std::adjacent_find(listed.begin(), listed.end()), listed.end()) << "each once";
    const double reach = widest / 16;
    bool is_away = true;
    for (std::uint32_t t = 0; t < count; ++t) {
      const Triangle3 seen = columns.seenTriangle(t);
      for (const double off : {-error, 0.0, error}) {
        const Point3 beside = {at[0] + off, at[1] - off, at[2]};
        if (!isUnder(seen, beside) || std::max({seen[0][2], seen[1][2], seen[2][2]}) < at[2]) continue;
        EXPECT_TRUE(std::binary_search(listed.begin(), listed.end(), t)) << t;
      }
      is_away = is_away && distance.enclose(at, seen).low > reach;
    }
    away += is_away;
    if (columns.isClear(at, reach / 4)) {
      for (std::uint32_t t = 0; t < count; ++t)
        EXPECT_GT(distance.enclose(at, columns.seenTriangle(t)).high, reach / 4);
      found.clear += is_away;
    }
  }
  found.clear /= std::max(away, 1.0);
  return found;
}

TEST(Columns, ListWhatIsAboveAPlaceAndLittleElse)
{
  const Found bumpy = look(test::bumpyMesh(24, 0.2), 0.0, 1), lattice = look(test::latticeMesh(12, 8, 3), 0.0, 2),
              fan = look(test::fanMesh(600), 0.0, 3);
  EXPECT_LT(bumpy.listed, 12) << "of 2208 triangles";
  EXPECT_LT(lattice.listed, 60);
  EXPECT_LT(fan.listed, 60) << "of 1200";
}

/// A small mesh of many triangles in a large box of few: all of them lie in one column of a grid over both.
TEST(Columns, ListLittleWhereTrianglesCrowd)
{
  test::ClosedMesh mesh;
  mesh.add(test::boxMesh(), 1.0);
  mesh.add(test::bumpyMesh(40, 0.1), 0.001, {0.5, 0.5, 0.5});
  const Columns columns(mesh.view());
  Random random(7);
  std::vector<std::uint32_t> several;
  double listed = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Point3 at = random.point([&] { return 0.5 + 0.001 * random.uniform(0, 1); });
    listed += static_cast<double>(columns.above(columns.seen(at), 0.0, several).size()) / 500;
  }
  EXPECT_LT(listed, 340) << "of 6252 triangles";
}

/// Finer grids and strips, which the columns of a place that may be in several of them have.
TEST(Columns, ListWhatIsAboveAnyOfSeveralCrowdedPlaces)
{
  test::ClosedMesh crowd;
  crowd.add(test::boxMesh(), 1.0);
  crowd.add(test::bumpyMesh(12, 0.1), 0.001, {0.5, 0.5, 0.5});
  const test::ClosedMesh fan = test::fanMesh(1000);
  Random random(8);
  std::vector<std::uint32_t> several;
  for (const test::ClosedMesh* const mesh : {static_cast<const test::ClosedMesh*>(&crowd), &fan}) {
    const Columns columns(mesh->view());
    const auto count = static_cast<std::uint32_t>(mesh->view().count);
    const double error = mesh == &crowd ? 0.00005 : 0.02;
    std::size_t under = 0, all = 0;
    for (int i = 0; i < 300; ++i) {
      Point3 q = random.point([&] { return 0.5 + 0.001 * random.uniform(0, 1); });
      if (mesh == &fan) q = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.5, 0.5)};
      const Point3 at = columns.seen(q);
      const Columns::Range listed = columns.above(at, error, several);
      all += listed.size();
      for (std::uint32_t t = 0; t < count; ++t) {
        const Triangle3 seen = columns.seenTriangle(t);
        if (std::max({seen[0][2], seen[1][2], seen[2][2]}) < at[2]) continue;
        for (const double off : {-error, 0.0, error}) {
          if (!isUnder(seen, {at[0] + off, at[1] - off, at[2]})) continue;
          ++under;
          ASSERT_TRUE(std::binary_search(listed.begin(), listed.end(), t)) << t;
        }
      }
    }
    EXPECT_GT(under, 1000u);
    EXPECT_LT(all, std::size_t{300} * count / 2) << "of " << count;
  }
}

TEST(Columns, OfNothingAreEmpty)
{
  test::ClosedMesh mesh;
  const std::uint32_t nan = mesh.vertex(NAN, 0, 0), at = mesh.vertex(1, 2, 3);
  EXPECT_TRUE(Columns(mesh.view()).empty());
  mesh.triangle(nan, at, at);
  const Columns nothing(mesh.view());
  EXPECT_TRUE(nothing.empty());
  EXPECT_TRUE(nothing.isBeyond({1, 2, 3}, 0.0));
  EXPECT_FALSE(nothing.isClear({1, 2, 3}, 0.0)) << "nothing is known";
  mesh.triangle(at, at, at);
  EXPECT_FALSE(Columns(mesh.view()).empty());
}

TEST(Columns, ListWhatIsAboveAnyOfSeveralPlaces)
{
  EXPECT_LT(look(test::bumpyMesh(24, 0.2), 0.01, 4).listed, 40);
}

TEST(Columns, AreClearAwayFromTheSurface)
{
  EXPECT_GT(look(test::bumpyMesh(24, 0.2), 0.0, 5).clear, 0.99);
  EXPECT_GT(look(test::boxMesh(), 0.0, 6).clear, 0.99);
}

/// A place may be off by as much as triangles are put into cells that they miss.
TEST(Columns, ListWhatIsHardlyBeyondARow)
{
  std::vector<std::uint32_t> several;
  for (int power = 1; power < 25; ++power) { // what the grid may have
    const double rows = std::ceil(std::pow(1.2, power)), pad = kCellPad / rows;
    for (double row = 1; row < rows; ++row)
      for (const double side : {-pad, pad}) {
        const double y = row / rows;
        test::ClosedMesh mesh;
        mesh.triangle(mesh.vertex(0, 0, 0), mesh.vertex(1, 0, 0), mesh.vertex(1, 1, 0));
        mesh.triangle(mesh.vertex(0, y + 0.4 * side, 0), mesh.vertex(1, y + 0.4 * side, 0),
                      mesh.vertex(0.5, y + 0.6 * side, 0));
        const Columns columns(mesh.view());
        const Columns::Range listed = columns.above(columns.seen({0.47, y - 0.2 * side, -1}), 0.9 * pad, several);
        ASSERT_NE(std::find(listed.begin(), listed.end(), 1u), listed.end()) << row << " of " << rows;
      }
  }
}

} // namespace
} // namespace pcl_bsh
