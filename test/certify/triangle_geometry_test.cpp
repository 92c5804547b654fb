// SPDX-License-Identifier: BSD-3-Clause
// Distances of triangles and winding numbers against CGAL's exact ones.
#include <pcl_bsh/geometry/triangle/triangle_distance.h>
#include <pcl_bsh/geometry/triangle/winding.h>

#include "support/random.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/squared_distance_3.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Number = Kernel::FT;
using test::Random;

Kernel::Point_3 placed(const Eigen::Isometry3d& pose, const Point3& p)
{
  Number at[3];
  for (int k = 0; k < 3; ++k) {
    at[k] = Number(pose(k, 3));
    for (int j = 0; j < 3; ++j) at[k] += Number(pose(k, j)) * Number(p[static_cast<std::size_t>(j)]);
  }
  return {at[0], at[1], at[2]};
}

Kernel::Triangle_3 placed(const Eigen::Isometry3d& pose, const Triangle3& t)
{
  return {placed(pose, t[0]), placed(pose, t[1]), placed(pose, t[2])};
}

/// Any, on a lattice, or thin; not degenerate, which CGAL does not take.
Triangle3 someTriangle(int kind, Random& random)
{
  for (;;) {
    const auto corner = [&] {
      return random.point(
          [&] { return kind == 1 ? std::ldexp(random.integer(-6, 6), -6) : random.uniform(-0.1, 0.1); });
    };
    Triangle3 t = {corner(), corner(), corner()};
    if (kind == 2)
      for (std::size_t k = 0; k < 3; ++k) t[2][k] = t[0][k] + 1e-5 * t[2][k];
    if (!placed(Eigen::Isometry3d::Identity(), t).is_degenerate()) return t;
  }
}

template <class A>
void expectAsCgal(const A& a, const Triangle3& b, const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b)
{
  const TriangleDistance distance(pose_a, pose_b);
  const Number squared = CGAL::squared_distance(placed(pose_a, a), placed(pose_b, b));
  const double length = distance.distance(a, b);
  for (const double clearance : {length, std::nextafter(length, 1e9), std::nextafter(length, 0.0), 0.0, 0.01}) {
    const Number reach(clearance);
    EXPECT_EQ(distance.compare(a, b, clearance), static_cast<int>(CGAL::compare(squared, reach * reach)));
  }
}

TEST(TriangleGeometry, DistancesAreThoseOfCgal)
{
  Random random(701);
  for (int kind = 0; kind < 3; ++kind)
    for (int i = 0; i < 150; ++i) {
      Eigen::Isometry3d pose_a = Eigen::Isometry3d::Identity(), pose_b = pose_a;
      if (i % 3 == 1) pose_a = random.pose(0.1);
      if (i % 3 == 2) pose_a = random.pose(1e5), pose_b = pose_a, pose_b.translation()(0) += 0.25;
      const Triangle3 a = someTriangle(kind, random), b = someTriangle(kind, random);
      expectAsCgal(a, b, pose_a, pose_b);
      expectAsCgal(a[0], b, pose_a, pose_b);
    }
}

TEST(TriangleGeometry, InsideIsThatOfCgal)
{
  using Polyhedron = CGAL::Polyhedron_3<Kernel>;
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  Random random(702);
  int inside = 0, on_surface = 0;
  for (int round = 0; round < 60; ++round) {
    const auto coordinate = [&] {
      return round % 2 == 0 ? std::ldexp(random.integer(-3, 3), -2) : random.uniform(-1, 1);
    };
    const Point3 a = random.point(coordinate), b = random.point(coordinate), c = random.point(coordinate),
                 d = random.point(coordinate);
    const auto turn =
        CGAL::orientation(placed(identity, a), placed(identity, b), placed(identity, c), placed(identity, d));
    if (turn == CGAL::COPLANAR) continue;
    Polyhedron body;
    body.make_tetrahedron(placed(identity, a), placed(identity, b), placed(identity, c), placed(identity, d));
    const std::vector<Triangle3> soup = {{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
    const CGAL::Side_of_triangle_mesh<Polyhedron, Kernel> side(body);
    const Winding winding(identity, identity, round % 3);
    for (int i = 0; i < 100; ++i) {
      const Point3 p = random.point(coordinate);
      const auto number = winding.number(p, soup.size(), [&](std::size_t k) { return soup[k]; });
      switch (side(placed(identity, p))) {
      case CGAL::ON_BOUNDARY:
        EXPECT_FALSE(number.has_value());
        ++on_surface;
        break;
      case CGAL::ON_BOUNDED_SIDE:
        EXPECT_EQ(number, static_cast<int>(turn));
        ++inside;
        break;
      default:
        EXPECT_EQ(number, 0);
      }
    }
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(on_surface, 20);
}

} // namespace
} // namespace pcl_bsh
