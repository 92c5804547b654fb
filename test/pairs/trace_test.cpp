// SPDX-License-Identifier: BSD-3-Clause
#include "support/random_clouds.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <pcl_bsh/pairs/trace.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::makePoints;
using test::Random;
using test::Shape;

AnyRequest within(double clearance)
{
  AnyRequest request;
  request.clearance = clearance;
  return request;
}

std::size_t countOf(const std::vector<TracedSphere>& spheres, SphereFate fate)
{
  return static_cast<std::size_t>(std::count_if(spheres.begin(), spheres.end(),
                                                [fate](const TracedSphere& sphere) { return sphere.fate == fate; }));
}

TEST(Trace, AnswersAsAnyCollisionDoesWithTheSameWork)
{
  Random random(71);
  for (const Shape shape : test::all_shapes) {
    const Cloud cloud_a(makePoints(shape, 3000, 1.0, random)), cloud_b(makePoints(Shape::sphere, 2000, 1.0, random));
    const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
    const SphereHierarchy fresh_a(cloud_a.view()), fresh_b(cloud_b.view());
    const Eigen::Isometry3d pose(Eigen::Translation3d(1.2, 0.3, -0.2));
    for (const double clearance : {0.0, 0.01, 0.2}) {
      const AnyResult expected = anyCollision({a}, {b, pose}, within(clearance));
      const CollisionTrace trace = traceCollision({fresh_a}, {fresh_b, pose}, within(clearance));
      EXPECT_EQ(trace.result.verdict, expected.verdict);
      EXPECT_EQ(trace.result.pair, expected.pair);
      EXPECT_EQ(test::countsOf(trace.result.work), test::countsOf(expected.work));
      for (const std::vector<TracedSphere>& spheres : {trace.a, trace.b})
        EXPECT_EQ(countOf(spheres, SphereFate::compared) > 0, expected.work.leaf_pairs > 0);
    }
  }
}

TEST(Trace, WhatWasNotOpenedCoversEveryPointWhenNothingCollides)
{
  Random random(72);
  const Cloud cloud_a(makePoints(Shape::plane, 20000, 1.0, random)),
      cloud_b(makePoints(Shape::sphere, 5000, 0.2, random));
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, 0.28));
  const CollisionTrace trace = traceCollision({a}, {b, pose}, within(0.001));
  ASSERT_EQ(trace.result.verdict, Verdict::free);
  EXPECT_EQ(countOf(trace.a, SphereFate::kept) + countOf(trace.b, SphereFate::kept), 0u) << "all were looked at";
  EXPECT_GT(countOf(trace.a, SphereFate::pruned), 0u);
  EXPECT_GT(countOf(trace.a, SphereFate::opened), 0u);
  for (std::uint32_t i = 0; i < cloud_a.view().count; ++i) {
    const Point3 p = cloud_a.view().point(i);
    EXPECT_TRUE(std::any_of(trace.a.begin(), trace.a.end(), [&](const TracedSphere& sphere) {
      const double x = p[0] - sphere.center[0], y = p[1] - sphere.center[1], z = p[2] - sphere.center[2];
      return sphere.fate != SphereFate::opened && std::sqrt(x * x + y * y + z * z) <= sphere.radius * (1 + 1e-6);
    })) << i;
  }
}

TEST(Trace, LevelsCountFromTheVoxels)
{
  Random random(73);
  const Cloud cloud(makePoints(Shape::uniform, 20000, 1.0, random));
  HierarchyOptions options;
  options.voxel_edge = 0.5;
  const SphereHierarchy a(cloud.view(), options), b(cloud.view(), options);
  const CollisionTrace trace = traceCollision({a}, {b}, within(0.0));
  EXPECT_EQ(trace.result.verdict, Verdict::colliding);
  std::vector<double> largest(8, 0.0);
  for (const TracedSphere& sphere : trace.a) {
    ASSERT_GE(sphere.level, -1);
    ASSERT_LT(sphere.level, 7);
    double& most = largest[static_cast<std::size_t>(sphere.level + 1)];
    most = std::max(most, sphere.radius);
  }
  EXPECT_GT(largest[1], 0.2) << "voxels' spheres";
  EXPECT_LT(largest[1], 0.5 * std::sqrt(3.0));
  EXPECT_GT(largest[2], 0.0);
  EXPECT_LT(largest[2], largest[1]);
}

TEST(Trace, OfCloudsFarApartIsTheirVoxels)
{
  const Cloud three({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}), one({{1000, 0, 0}});
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  const SphereHierarchy a(three.view(), options), b(one.view(), options);
  const CollisionTrace trace = traceCollision({a}, {b}, within(1.0));
  EXPECT_EQ(trace.a.size(), 3u);
  EXPECT_EQ(trace.b.size(), 1u);
  EXPECT_EQ(countOf(trace.a, SphereFate::pruned), 3u);
}

TEST(Trace, WhatWaitsWhenACollisionIsFoundIsKept)
{
  const Cloud three({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}), one({{0, 0, 0}});
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  const SphereHierarchy many(three.view(), options), single(one.view(), options);
  for (const std::vector<TracedSphere>& spheres :
       {traceCollision({many}, {single}, within(25.0)).a, traceCollision({single}, {many}, within(25.0)).b}) {
    EXPECT_GE(countOf(spheres, SphereFate::kept), 2u);
    EXPECT_EQ(countOf(spheres, SphereFate::pruned), 0u) << "all are within reach";
  }
}

TEST(Trace, EmptyCloudsAndRefusals)
{
  const SphereHierarchy nothing{PointsView{}};
  const CollisionTrace trace = traceCollision({nothing}, {nothing}, within(1.0));
  EXPECT_EQ(trace.result.verdict, Verdict::free);
  EXPECT_TRUE(trace.a.empty() && trace.b.empty());
  AnyRequest request = within(-1.0);
  EXPECT_THROW(traceCollision({nothing}, {nothing}, request), std::invalid_argument);
  request = within(1.0);
  request.accuracy = Accuracy::nodePairs(5);
  EXPECT_THROW(traceCollision({nothing}, {nothing}, request), std::invalid_argument);
}

} // namespace
} // namespace pcl_bsh
