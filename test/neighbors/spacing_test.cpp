// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/spacing.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

using test::Cloud;

/// Distances to the nearest point elsewhere, of all points, ascending.
std::vector<double> allGaps(const std::vector<Point3>& points)
{
  std::vector<double> gaps;
  for (const Point3& p : points) {
    double nearest = 1e300;
    for (const Point3& q : points) {
      const double d = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
      if (d > 0) nearest = std::min(nearest, d);
    }
    gaps.push_back(nearest);
  }
  std::sort(gaps.begin(), gaps.end());
  return gaps;
}

TEST(Spacing, SmallCloudsAreAskedWhole)
{
  test::Random random(3);
  for (const test::Shape shape :
       {test::Shape::uniform, test::Shape::plane, test::Shape::clusters, test::Shape::outlier}) {
    const std::vector<Point3> points = test::makePoints(shape, 700, 8.0, random);
    const Cloud cloud(points, {Scalar::float64, 0, 0});
    HierarchyOptions options;
    options.voxel_edge = 1.0;
    const Spacing spacing = spacingOf(SphereHierarchy(cloud.view(), options));
    const std::vector<double> gaps = allGaps(points);
    EXPECT_EQ(spacing.samples, 700u);
    EXPECT_NEAR(spacing.median, gaps[350], 1e-5 * gaps[350]);
    EXPECT_NEAR(spacing.wide, gaps[630], 1e-5 * gaps[630]);
  }
}

TEST(Spacing, SamplesOfAGreatCloudTellItsSpacing)
{
  test::Random random(4);
  const std::vector<Point3> points = test::makePoints(test::Shape::plane, 6000, 8.0, random);
  const Cloud cloud(points);
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  const SphereHierarchy hierarchy(cloud.view(), options);
  const Spacing spacing = spacingOf(hierarchy), again = spacingOf(hierarchy);
  const double median = allGaps(points)[3000];
  EXPECT_LE(spacing.samples, 1024u);
  EXPECT_GE(spacing.samples, 512u);
  EXPECT_NEAR(spacing.median, median, 0.1 * median);
  EXPECT_EQ(spacing.median, again.median);
  EXPECT_EQ(spacing.wide, again.wide);
}

TEST(Spacing, BuildsFewVoxels)
{
  test::Random random(5);
  const Cloud cloud(test::makePoints(test::Shape::plane, 200000, 8.0, random));
  HierarchyOptions options;
  options.voxel_edge = 0.25;
  const SphereHierarchy hierarchy(cloud.view(), options);
  spacingOf(hierarchy);
  EXPECT_LT(hierarchy.statistics().voxels_built, hierarchy.statistics().voxels / 5);
}

TEST(Spacing, CrowdsAtOnePlaceDoNotHideTheNextPlace)
{
  std::vector<float> points;
  for (const float x : {0.0f, 5.0f, 7.0f})
    for (int i = 0; i < 3000; ++i) points.insert(points.end(), {x, 0.0f, 0.0f});
  const Spacing spacing = spacingOf(SphereHierarchy(viewOf(points.data(), points.size() / 3)));
  EXPECT_EQ(spacing.median, 2.0);
  EXPECT_EQ(spacing.wide, 5.0);
}

TEST(Spacing, DoubledPointsAreOnePlace)
{
  const std::vector<float> points = {0, 0, 0, 0, 0, 0, 3, 0, 0, 3, 0, 0};
  EXPECT_EQ(spacingOf(SphereHierarchy(viewOf(points.data(), 4))).median, 3.0);
}

/// A voxel stores floats relative to its middle: these may be one place where the given ones are many.
TEST(Spacing, OfPlacesThatFloatsDoNotTellApart)
{
  std::vector<Point3> points;
  for (int i = 0; i < 100; ++i) points.push_back({1.0 + 1e-10 * i, 0.0, 0.0});
  points.push_back({1e4, 0.0, 0.0});
  const Cloud cloud(points, {Scalar::float64, 0, 0});
  for (const double edge : {0.0, 2e4}) {
    HierarchyOptions options;
    options.voxel_edge = edge;
    const Spacing spacing = spacingOf(SphereHierarchy(cloud.view(), options));
    EXPECT_NEAR(spacing.median, 1e-10, 1e-16);
    EXPECT_NEAR(spacing.wide, 1e-10, 1e-16);
  }
}

TEST(Spacing, OnePlaceHasNone)
{
  const std::vector<float> points(300, 1.0f);
  EXPECT_EQ(spacingOf(SphereHierarchy(viewOf(points.data(), 100))).median, 0.0);
  EXPECT_EQ(spacingOf(SphereHierarchy(PointsView{})).samples, 0u);
}

} // namespace
} // namespace pcl_bsh
