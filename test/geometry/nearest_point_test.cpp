// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/nearest_point.h>

#include "support/random.h"

#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_bsh {
namespace {

double apart(const Point3& p, const Point3& q)
{
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// Any triangle, a needle, a segment or a point.
Triangle3 someTriangle(int kind, test::Random& random)
{
  const auto any = [&] { return random.uniform(-1, 1); };
  Triangle3 t = {random.point(any), random.point(any), random.point(any)};
  for (std::size_t k = 0; k < 3 && kind > 0; ++k)
    t[2][k] = kind == 1 ? t[0][k] + 1e-4 * t[2][k] : kind == 2 ? 0.5 * (t[0][k] + t[1][k]) : t[0][k];
  if (kind == 3) t[1] = t[0];
  return t;
}

TEST(NearestPoint, IsAsFarAsTheTriangle)
{
  const TriangleDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
  test::Random random(41);
  for (int i = 0; i < 4000; ++i) {
    const Triangle3 t = someTriangle(i % 4, random);
    const Point3 p = random.point([&] { return random.uniform(-2, 2); }), nearest = nearestPoint(p, t);
    EXPECT_NEAR(apart(p, nearest), distance.distance(p, t), 1e-9) << i;
    EXPECT_LT(distance.distance(nearest, t), 1e-9) << i;
  }
}

TEST(NearestPoint, OfTwoTrianglesAreAsFarAsThese)
{
  const TriangleDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
  test::Random random(42);
  for (int i = 0; i < 1000; ++i) {
    const Triangle3 a = someTriangle(i % 4, random);
    Triangle3 b = someTriangle(i / 4 % 4, random);
    for (Point3& corner : b) corner[0] += 3.0; // apart
    const auto [p, q] = nearestPoints(a, b);
    EXPECT_NEAR(apart(p, q), distance.distance(a, b), 1e-3) << i;
  }
}

} // namespace
} // namespace pcl_bsh
