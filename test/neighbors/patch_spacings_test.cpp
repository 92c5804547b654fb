// SPDX-License-Identifier: BSD-3-Clause
// The width of the holes between samples: grids, lines of a scan, random surfaces, what is no surface.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/neighbors/patch_spacings.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

/// Lines along x, `along` between their points and `across` between them; tilted, so that no axis is special.
std::vector<Point3> lines(int count, double along, double across)
{
  std::vector<Point3> points;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i) points.push_back({along * i, across * j, 0.25 * along * i - 0.5 * across * j});
  return points;
}

std::vector<float> spacingsOf(const std::vector<Point3>& points, double widest_gap, unsigned threads = 1)
{
  const Cloud cloud(points, {Scalar::float64});
  return patchSpacings(SphereHierarchy(cloud.view()), widest_gap, threads);
}

TEST(PatchSpacings, OfAGridAreItsDiagonals)
{
  std::vector<Point3> points;
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) points.push_back({0.25 * i, 0.25 * j, 1.0});
  for (const float spacing : spacingsOf(points, 1.0)) EXPECT_NEAR(spacing, 0.25 * std::sqrt(2.0), 1e-6);
  // Wider than allowed, a hole is an opening.
  for (const float spacing : spacingsOf(points, 0.3)) EXPECT_EQ(spacing, 0.0f);
}

TEST(PatchSpacings, SeeTheGapsBetweenLines)
{
  const double along = 0.01, across = 0.25;
  const std::vector<float> spacings = spacingsOf(lines(40, along, across), 0.5);
  const double apart_x = along * std::sqrt(1 + 0.0625), apart_y = across * std::sqrt(1.25);
  for (int j = 0; j < 40; ++j)
    for (int i = 5; i < 35; ++i)
      EXPECT_NEAR(spacings[static_cast<std::size_t>(40 * j + i)], std::hypot(apart_x, apart_y), 0.05 * across);
  for (const float spacing : spacingsOf(lines(40, along, across), 0.2))
    EXPECT_LE(spacing, 0.2f) << "lines are apart by more than what is taken for a hole";
}

/// The promise: on a plane, each place in a hole is within half of the spacing of its nearest sample.
TEST(PatchSpacings, CoverAPlane)
{
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Random random(seed);
    std::vector<Point3> points;
    for (int i = 0; i < 1500; ++i) {
      const double x = random.uniform(0, 1), y = random.uniform(0, 1);
      if (seed % 2 == 1 && std::hypot(x - 0.5, y - 0.5) < 0.1) continue; // a hole
      points.push_back({x, y, 0.25 * x - 0.5 * y});
    }
    const std::vector<float> spacings = spacingsOf(points, 1.0);
    for (int i = 0; i < 1000; ++i) {
      const double x = random.uniform(0.2, 0.8), y = random.uniform(0.2, 0.8), z = 0.25 * x - 0.5 * y;
      double slack = std::numeric_limits<double>::infinity();
      for (std::size_t q = 0; q < points.size(); ++q) {
        const Point3& p = points[q];
        slack = std::min(slack, std::hypot(p[0] - x, p[1] - y, p[2] - z) - 0.5 * static_cast<double>(spacings[q]));
      }
      EXPECT_LE(slack, 1e-7) << seed << ": " << x << ' ' << y;
    }
  }
}

TEST(PatchSpacings, SameForAnyThreads)
{
  Random random(5);
  const std::vector<Point3> points = test::makePoints(test::Shape::sphere, 3000, 1.0, random);
  EXPECT_EQ(spacingsOf(points, 0.3, 1), spacingsOf(points, 0.3, 4));
}

TEST(PatchSpacings, OfWhatIsNoSurface)
{
  EXPECT_TRUE(spacingsOf({}, 1.0).empty());
  EXPECT_EQ(spacingsOf({{1, 2, 3}}, 1.0), std::vector<float>{0.0f});
  EXPECT_EQ(spacingsOf(std::vector<Point3>(50, Point3{1, 2, 3}), 1.0), std::vector<float>(50, 0.0f));
  std::vector<Point3> wire;
  for (int i = 0; i < 100; ++i) wire.push_back({0.125 * i, 0, 0});
  for (const float spacing : spacingsOf(wire, 1.0)) EXPECT_EQ(spacing, 0.0f);
  for (const test::Shape shape : test::all_shapes) {
    Random random(7);
    for (const float spacing : spacingsOf(test::makePoints(shape, 300, 1.0, random), 0.25)) {
      EXPECT_GE(spacing, 0.0f);
      EXPECT_LE(spacing, 0.25f);
    }
  }
  std::vector<Point3> points(3, Point3{0, 0, 0});
  points[1][0] = std::nan("");
  EXPECT_EQ(spacingsOf(points, 1.0), std::vector<float>(3, 0.0f));
  for (const double wrong : {0.0, -1.0, std::nan("")}) EXPECT_THROW(spacingsOf(points, wrong), InvalidInput);
}

} // namespace
} // namespace pcl_bsh
