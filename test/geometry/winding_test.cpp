// SPDX-License-Identifier: BSD-3-Clause
// Winding numbers against rays in random directions that are counted in rational numbers; points where rays along axes
// pass through edges and corners, and points on the surface.
#include <pcl_bsh/geometry/triangle/winding.h>

#include "edge_chains.h"
#include "soups.h"
#include "triangle_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

namespace pcl_bsh {
namespace {

using Eigen::Isometry3d;
using test::both;
using test::boxOf;
using test::flipped;
using test::posed;
using test::Random;
using test::Rational;
using test::RationalPoint;
using test::RationalTriangle;
using test::Soup;
using test::tetrahedronOf;

const Isometry3d identity = Isometry3d::Identity();

/// By a ray in a random direction that meets no edge; nothing on the surface.
std::optional<int> expectedNumber(const Isometry3d& pose_a, const Point3& p, const Isometry3d& pose_b, const Soup& soup,
                                  Random& random)
{
  const RationalPoint from = posed(pose_a, p);
  std::vector<RationalTriangle> triangles; // but those in a plane with the point, which it leaves at once
  for (const Triangle3& triangle : soup) {
    const RationalTriangle t = posed(pose_b, triangle);
    if (dot(cross(t[1] - t[0], t[2] - t[0]), t[0] - from) != 0)
      triangles.push_back(t);
    else if (test::squaredDistance(from, t) == 0)
      return std::nullopt;
  }
  for (;;) {
    const auto component = [&] { return Rational(random.integer(-1000000, 1000000)); };
    const RationalPoint way = {component(), component(), component()};
    int turns = 0;
    bool generic = true;
    for (const RationalTriangle& t : triangles) {
      const RationalPoint w[3] = {t[0] - from, t[1] - from, t[2] - from};
      const RationalPoint normal = cross(w[1] - w[0], w[2] - w[0]);
      int sides[3];
      for (std::size_t i = 0; i < 3; ++i) sides[i] = dot(way, cross(w[i], w[(i + 1) % 3])).sign();
      if (sides[0] == 0 || sides[1] == 0 || sides[2] == 0) {
        generic = false;
        break;
      }
      if (sides[0] != sides[1] || sides[1] != sides[2]) continue;
      if (dot(normal, w[0]).sign() * dot(normal, way).sign() > 0) turns += dot(normal, way).sign();
    }
    if (generic) return turns;
  }
}

void expectNumbers(const Soup& soup, const std::vector<Point3>& points, const Isometry3d& pose_a,
                   const Isometry3d& pose_b, Random& random)
{
  const auto triangle = [&](std::size_t i) { return soup[i]; };
  for (const Point3& p : points) {
    const std::optional<int> expected = expectedNumber(pose_a, p, pose_b, soup, random);
    for (const int axis : {0, 1, 2})
      EXPECT_EQ(Winding(pose_a, pose_b, axis).number(p, soup.size(), triangle), expected)
          << testing::PrintToString(p) << ", axis " << axis;
  }
}

std::vector<Point3> latticeOf(int low, int high)
{
  std::vector<Point3> points;
  for (int x = low; x <= high; ++x)
    for (int y = low; y <= high; ++y)
      for (int z = low; z <= high; ++z) points.push_back({x / 2.0, y / 2.0, z / 2.0});
  return points;
}

TEST(Winding, OfBoxesThroughEdgesAndCorners)
{
  Random random(601);
  const Soup box = boxOf({0, 0, 0}, {2, 2, 2}), inner = boxOf({1, 1, 1}, {1.5, 1.5, 1.5}),
             other = boxOf({1, 0, 0}, {3, 2, 1});
  const auto lattice = latticeOf(-1, 6);
  expectNumbers(box, lattice, identity, identity, random);
  expectNumbers(both(box, inner), lattice, identity, identity, random);          // nested: 2 inside
  expectNumbers(both(box, flipped(inner)), lattice, identity, identity, random); // a hole: 0 inside
  expectNumbers(both(box, other), lattice, identity, identity, random);          // overlapping, sides in one plane
  expectNumbers(both(box, flipped(box)), lattice, identity, identity, random);   // faces doubled: 0 everywhere
}

/// Rays leave through corners and through edges that lie along each axis, without a second such on the way.
TEST(Winding, OfAnOctahedron)
{
  Random random(606);
  Soup soup;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) {
        const Point3 a = {x, 0, 0}, b = {0, y, 0}, c = {0, 0, z};
        soup.push_back(x * y * z > 0 ? Triangle3{a, b, c} : Triangle3{a, c, b});
      }
  expectNumbers(soup, latticeOf(-3, 3), identity, identity, random);
}

TEST(Winding, OfTrianglesWithoutArea)
{
  Random random(602);
  // One side of the box is cut at a corner of its neighbour's: a triangle without area closes the gap.
  Soup box = boxOf({0, 0, 0}, {2, 2, 2});
  const Point3 a = {0, 0, 2}, b = {2, 0, 2}, middle = {1, 0, 2};
  for (Triangle3& t : box)
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] == a && t[(k + 1) % 3] == b) {
        const Point3 c = t[(k + 2) % 3];
        t = {a, middle, c};
        box.push_back({middle, b, c});
        box.push_back({a, b, middle});
        break;
      }
  EXPECT_TRUE(test::chainOf(test::edgesOf(box)).empty());
  box.push_back({a, a, b});
  box.push_back({b, b, b});
  expectNumbers(box, latticeOf(-1, 5), identity, identity, random);
}

/// Triangles cut by themselves: rays leave through corners that lie within edges of neighbours.
TEST(Winding, OfCornersWithinEdges)
{
  Random random(628);
  const Soup tent = tetrahedronOf({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4});
  for (Soup soup : {boxOf({0, 0, 0}, {2, 2, 2}), tent, both(boxOf({0, 0, 0}, {2, 2, 2}), flipped(tent))}) {
    for (int cuts = 0; cuts < 24; ++cuts) {
      Triangle3& t = soup[static_cast<std::size_t>(random.integer(0, static_cast<int>(soup.size()) - 1))];
      const int k = random.integer(0, 2);
      std::rotate(t.begin(), t.begin() + k, t.end());
      const Point3 middle = {(t[0][0] + t[1][0]) / 2, (t[0][1] + t[1][1]) / 2, (t[0][2] + t[1][2]) / 2};
      const Triangle3 rest = {middle, t[1], t[2]};
      t[1] = middle;
      soup.push_back(rest);
    }
    EXPECT_TRUE(test::chainOf(test::edgesOf(soup)).empty());
    expectNumbers(soup, latticeOf(-1, 5), identity, identity, random);
  }
}

TEST(Winding, LeavesOutTrianglesThatAreNotFinite)
{
  constexpr double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  for (const double x : bad)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Soup box = boxOf({0, 0, 0}, {2, 2, 2});
      Triangle3 odd = box.front();
      odd[corner][corner] = x;
      box.insert(box.begin() + 3, odd);
      const auto number = [&](const Point3& p) {
        return Winding(identity, identity).number(p, box.size(), [&](std::size_t i) { return box[i]; });
      };
      EXPECT_EQ(number({1, 1, 0.5}), 1);
      EXPECT_EQ(number({3, 1, 0.5}), 0);
      EXPECT_EQ(number({0, 1, 1}), std::nullopt);
    }
}

TEST(Winding, UnderPoses)
{
  Random random(603);
  Isometry3d far = identity;
  far.pretranslate(Eigen::Vector3d(513449.75, 5402650.25, -0.125));
  for (int i = 0; i < 20; ++i) {
    const auto corner = [&] { return random.point([&] { return random.uniform(-1, 1); }); };
    const Soup soup = both(tetrahedronOf(corner(), corner(), corner(), corner()),
                           tetrahedronOf(corner(), corner(), corner(), corner()));
    std::vector<Point3> points;
    for (int k = 0; k < 20; ++k) points.push_back(random.point([&] { return random.uniform(-0.6, 0.6); }));
    points.push_back(soup[0][0]);
    for (std::size_t k = 0; k < 3; ++k) points.push_back({soup[0][0][0], soup[0][1][1], soup[0][k][2]});
    const Isometry3d pose = random.pose(1e6);
    expectNumbers(soup, points, identity, identity, random);
    expectNumbers(soup, points, far, far, random);
    expectNumbers(soup, points, pose, pose, random);
  }
}

/// Points one unit in the last place from a side, and on it as far as rounding lets them.
TEST(Winding, NextToTheSurface)
{
  Random random(604);
  const Soup box = boxOf({0, 0, 0}, {1, 1, 1});
  for (int i = 0; i < 60; ++i) {
    const Isometry3d pose = random.pose(10.0);
    const Eigen::Vector3d on = pose * Eigen::Vector3d{random.uniform(0, 1), random.uniform(0, 1), 1.0};
    Point3 p = {on(0), on(1), on(2)};
    std::vector<Point3> points = {p};
    for (std::size_t k = 0; k < 3; ++k)
      for (const double to : {-100.0, 100.0}) {
        Point3 q = p;
        q[k] = std::nextafter(q[k], to);
        points.push_back(q);
      }
    expectNumbers(box, points, identity, pose, random);
  }
}

TEST(Winding, DoublesDecideMostCrossings)
{
  Random random(605);
  Winding::Stages stages;
  const Isometry3d pose = random.pose(1e6);
  const Winding winding(pose, pose);
  for (int i = 0; i < 10000; ++i) {
    const auto corner = [&] { return random.point([&] { return random.uniform(-1, 1); }); };
    winding.crossing(random.chance(0.5) ? corner() : Point3{0, 0, 0}, {corner(), corner(), corner()}, &stages);
  }
  std::printf("  crossings: %llu in double, %llu in long numbers, %llu in integers\n",
              static_cast<unsigned long long>(stages.doubles), static_cast<unsigned long long>(stages.long_numbers),
              static_cast<unsigned long long>(stages.integers));
  EXPECT_GT(stages.doubles, 9990u);
}

} // namespace
} // namespace pcl_bsh
