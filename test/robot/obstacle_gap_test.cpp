// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/robot/obstacle_gap.h>

#include "made_arms.h"
#include <pcl_bsh/geometry/triangle/triangle_distance.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/robot/convex_distance.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

namespace pcl_bsh {
namespace {

using namespace robots;

Solid madeSolid(test::Random& random, int kind)
{
  const double r = random.uniform(0.02, 0.3), l = random.uniform(0.02, 0.5);
  if (kind == 0) return Sphere{r};
  if (kind == 1) return Capsule{r, l};
  if (kind == 2) return Cylinder{r, l};
  return Box{{r, l, 0.5 * (r + l)}};
}

Kinematics::Pose madePlace(test::Random& random)
{
  const Eigen::Isometry3d pose = test::madePose(random, 0.6);
  return {pose.linear(), pose.translation()};
}

std::vector<float> madeFloats(test::Random& random, std::size_t count, double low, double high)
{
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(random.uniform(low, high));
  return values;
}

TEST(Shapes, DistancesAreThoseToTheirSupports)
{
  test::Random random(1);
  for (const int kind : {0, 1, 2, 3})
    for (int i = 0; i < 300; ++i) {
      const Solid solid = madeSolid(random, kind);
      const Eigen::Vector3d p = test::madeVector(random, 1.0), q = test::madeVector(random, 1.0);
      const Eigen::Vector3d d = test::madeVector(random, 1.0).normalized();
      const double at_p = signedDistance(solid, p);
      EXPECT_LE(std::abs(at_p - signedDistance(solid, q)), (p - q).norm() + 1e-12);
      EXPECT_LE(p.norm() - enclosingRadius(solid), at_p + 1e-12);
      const Eigen::Vector3d farthest = support(solid, d) + roundness(solid) * d;
      EXPECT_NEAR(signedDistance(solid, farthest), 0.0, 1e-12) << kind;
      EXPECT_LE(d.dot(p) - d.dot(farthest), std::max(at_p, 0.0) + 1e-12) << kind; // which is beyond all of it
      if (at_p <= 0.0) continue;
      const Interval by_steps =
          convexDistance([&](const Eigen::Vector3d& along) { return support(solid, along); },
                         [&](const Eigen::Vector3d&) { return p; }, [](const Interval&) { return false; }, q);
      EXPECT_LE(by_steps.lower - roundness(solid), at_p + 1e-12);
      EXPECT_GE(by_steps.upper - roundness(solid), at_p - 1e-12);
      EXPECT_LT(by_steps.upper - by_steps.lower, 1e-7) << kind;
    }
}

/// Bounds end as soon as they tell: here at the first direction, which is the way between the middles.
TEST(Shapes, AreApartByOneDirection)
{
  const auto cube = [](const Eigen::Vector3d& middle, int& asked) {
    return [&middle, &asked](const Eigen::Vector3d& along) {
      ++asked;
      return Eigen::Vector3d(middle + support(Box{{1, 1, 1}}, along));
    };
  };
  const Eigen::Vector3d here(0, 0, 0), there(0.1, 4, 0.2);
  int asked = 0;
  const Interval bounds = convexDistance(
      cube(here, asked), cube(there, asked), [](const Interval& of) { return of.lower > 2.5; }, here - there);
  EXPECT_GT(bounds.lower, 2.5);
  EXPECT_LE(bounds.lower, 3.0);
  EXPECT_EQ(asked, 2);
}

TEST(Shapes, AreDeepInside)
{
  EXPECT_DOUBLE_EQ(signedDistance(Solid(Box{{2, 4, 6}}), {0.5, 0, 0}), -0.5);
  EXPECT_DOUBLE_EQ(signedDistance(Solid(Cylinder{1, 6}), {0, 0.25, 0}), -0.75);
  EXPECT_DOUBLE_EQ(signedDistance(Solid(Capsule{1, 2}), {0, 0, 1.5}), -0.5);
  EXPECT_DOUBLE_EQ(signedDistance(Solid(Sphere{1}), {0, 0, 0}), -1.0);
}

/// The bounds hold the least gap of all records; beyond the limit nothing is found.
TEST(ObstacleGap, HoldsTheLeastGap)
{
  test::Random random(2);
  for (const std::size_t count : {1u, 30u, 3000u})
    for (const int radii : {0, 1, 2}) {
      const std::vector<float> xyz = madeFloats(random, 3 * count, -1, 1);
      std::vector<float> balls = radii == 1 ? std::vector<float>(count, 0.01f) : madeFloats(random, count, 0, 0.1);
      PointsView view = viewOf(xyz.data(), count);
      if (radii != 0) view.radii = balls.data();
      const SphereHierarchy cloud(view);
      const Obstacle obstacle(cloud);
      for (int i = 0; i < 60; ++i) {
        const Solid solid = madeSolid(random, i % 4);
        const Kinematics::Pose pose = madePlace(random);
        double least = std::numeric_limits<double>::infinity(), of_place = least;
        for (std::uint32_t k = 0; k < count; ++k) {
          const Point3 p = view.point(k);
          const Eigen::Vector3d seen =
              pose.rotation.transpose() * (Eigen::Vector3d(p[0], p[1], p[2]) - pose.translation);
          least = std::min(least, signedDistance(solid, seen) - view.radius(k));
          of_place = std::min(of_place, seen.norm() - view.radius(k));
        }
        const double limit = random.uniform(0, 0.4);
        const Gap gap = obstacle.gap(solid, pose, limit);
        EXPECT_EQ(obstacle.isBeyond(pose.translation, limit), of_place > limit) << of_place << " " << limit;
        EXPECT_FALSE(obstacle.isBeyond(pose.translation, std::numeric_limits<double>::infinity()));
        EXPECT_LE(gap.lower, least + 1e-12);
        if (least > limit) {
          EXPECT_TRUE(gap.isBeyond(limit - 1e-12)) << least << " " << limit;
          continue;
        }
        EXPECT_GE(gap.upper, least - 1e-12);
        EXPECT_LT(gap.upper - gap.lower, 1e-6);
      }
    }
}

TEST(ObstacleGap, OfTrianglesIsThatOfTheirInsides)
{
  const std::vector<float> xyz = {-1, -1, 0, 1, -1, 0, 0, 2, 0};
  const std::vector<std::uint32_t> corners = {0, 1, 2};
  const SphereHierarchy mesh(viewOf(TrianglesView{viewOf(xyz.data(), 3), corners.data(), 1}));
  const Obstacle obstacle(mesh);
  const Kinematics::Pose above{Eigen::Matrix3d::Identity(), {0, 0, 0.75}};
  for (const Solid& solid :
       {Solid(Sphere{0.25}), Solid(Box{{0.5, 0.5, 0.5}}), Solid(Capsule{0.125, 0.25}), Solid(Cylinder{0.25, 0.5})}) {
    const Gap gap = obstacle.gap(solid, above, 2.0);
    EXPECT_LE(gap.lower, 0.5 + 1e-12);
    EXPECT_NEAR(gap.lower, 0.5, 1e-6);
    EXPECT_NEAR(gap.upper, 0.5, 1e-6);
    EXPECT_EQ(gap.record, 0u);
    EXPECT_TRUE(obstacle.gap(solid, above, 0.4).isBeyond(0.4 - 1e-12));
  }
}

/// Triangles of all widths, of which some are narrower than those whose planes are known, and more than these.
TEST(ObstacleGap, OfPatchesIsThatOfTheirTriangles)
{
  test::Random random(3);
  const std::vector<float> points = madeFloats(random, 3 * 300, -1, 1);
  const PointsView view = viewOf(points.data(), 300);
  const SphereHierarchy cloud(view);
  const Obstacle obstacle(cloud);
  for (int i = 0; i < 60; ++i) {
    constexpr std::size_t kTriangles = 20;
    std::vector<float> xyz = madeFloats(random, 9 * kTriangles, -0.2, 0.2);
    if (i % 2 == 0)
      for (std::size_t k = 6; k < xyz.size(); k += 9)
        for (std::size_t axis = 0; axis < 3; ++axis) xyz[k + axis] = xyz[k + axis - 3] * (1.0f + 1e-5f);
    std::vector<std::uint32_t> corners(3 * kTriangles), records(kTriangles);
    std::iota(corners.begin(), corners.end(), 0u);
    std::iota(records.begin(), records.end(), 0u);
    const SphereHierarchy mesh(viewOf(TrianglesView{viewOf(xyz.data(), 3 * kTriangles), corners.data(), kTriangles}));
    const Kinematics::Pose pose = madePlace(random);
    const Patch patch{mesh, records.data(), records.data() + records.size(), pose.translation, 0.4};
    const TriangleDistance exact(Eigen::Isometry3d::Identity(), pose.isometry());
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t p = 0; p < view.count; ++p)
      for (const std::uint32_t& record : records)
        least = std::min(least, exact.distance(view.point(p), patch.triangle(&record)));
    const double limit = random.uniform(0, 0.4);
    const Gap gap = obstacle.gap(patch, pose, limit), any = obstacle.gap(patch, pose, limit, true);
    EXPECT_EQ(any.record == kNothing, least > limit);
    EXPECT_NEAR(obstacle.gap(patch, pose, 1.0001 * least, true).upper, least, 1.0001e-4 * least); // no bound is above
    if (any.record != kNothing) {
      EXPECT_GE(any.upper, least - 1e-14);
      EXPECT_LE(any.upper, limit + 1e-14);
    }
    EXPECT_LE(gap.lower, least + 1e-14);
    EXPECT_EQ(gap.record == kNothing, least > limit);
    if (least > limit) continue;
    EXPECT_NEAR(gap.lower, least, 1e-12);
    EXPECT_NEAR(gap.upper, least, 1e-12);
  }
}

} // namespace
} // namespace pcl_bsh
