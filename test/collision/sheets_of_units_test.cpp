// SPDX-License-Identifier: BSD-3-Clause
// Sheets that face each other, turned, so small or so large that their voxels measure in other units: in one, or each
// in its own. Slabs, which decide there, are in these units.
#include <pcl_bsh/collision/brute_force.h>
#include <pcl_bsh/collision/collide.h>
#include <pcl_bsh/hierarchy/storage.h>

#include "../query/random_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

/// A sheet of that size at that height, a little bent, and as thick as told.
std::vector<Point3> sheet(std::size_t count, double size, double height, double thickness, Random& random)
{
  std::vector<Point3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    points.push_back({size * x, size * y, height + 0.02 * size * x * y + thickness * random.uniform(-1, 1)});
  }
  return points;
}

double unitOf(const SphereHierarchy& hierarchy)
{
  return hierarchy.storage().voxels[0].frame.unit;
}

/// @param of_b the second sheet's size, the first one's is 1. @return the work of the first pair found, or of none
std::uint64_t expectTruth(std::uint64_t seed, double scale, double of_b, bool same_unit, double& unit)
{
  Random random(seed);
  const double gap = 0.04 * std::min(1.0, of_b);
  const Eigen::Isometry3d place = random.pose(scale), other(random.rotation());
  const std::vector<Point3> lower = sheet(600, scale, 0, 0.1 * gap * scale, random);
  std::vector<Point3> upper = sheet(600, of_b * scale, gap * scale, 0.1 * gap * scale, random);
  for (Point3& p : upper) {
    const Eigen::Vector3d turned = other * Eigen::Vector3d(p[0], p[1], p[2]);
    p = {turned[0], turned[1], turned[2]};
  }
  const Cloud one(lower, {Scalar::float64, 0, 0}), two(upper, {Scalar::float64, 0, 0});
  HierarchyOptions one_voxel;
  one_voxel.voxel_edge = 8 * scale;
  const SphereHierarchy a(one.view(), one_voxel), b(two.view(), one_voxel);
  const Placed at_a{a, place}, at_b{b, place * other.inverse()};
  unit = unitOf(a);
  EXPECT_EQ(unit == unitOf(b), same_unit);
  const DistanceResult truth = brute_force::closestPair(at_a, at_b);
  const DistanceResult found = closestPair(at_a, at_b);
  EXPECT_EQ(found.distance, truth.distance);
  EXPECT_EQ(found.pair, truth.pair);
  std::uint64_t work = 0;
  const double d = truth.distance; // rounded
  for (const double clearance : {0.5 * d, std::nextafter(d, 0.0), std::nextafter(d, 2 * d), 1.5 * d}) {
    AnyRequest request;
    request.clearance = clearance;
    const AnyResult any = anyCollision(at_a, at_b, request);
    EXPECT_EQ(any.verdict, clearance < d ? Verdict::free : Verdict::colliding) << clearance / d;
    if (clearance == 0.5 * d) work = any.work.node_pairs;
  }
  return work;
}

TEST(SheetsOfUnits, AnyAndClosestAreAsBruteForceSays)
{
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    double usual = 0.0, unit = 0.0;
    const std::uint64_t work = expectTruth(seed, 1.0, 1.0, true, usual);
    EXPECT_EQ(usual, 1.0);
    for (const double scale : {0x1p-33, 0x1p-60, 0x1p-200, 0x1p62, 0x1p100}) {
      SCOPED_TRACE(std::to_string(seed) + ", scale 2^" + std::to_string(std::ilogb(scale)));
      const std::uint64_t scaled = expectTruth(seed, scale, 1.0, true, unit);
      EXPECT_NE(unit, 1.0);
      EXPECT_LT(static_cast<double>(scaled), 3.0 * static_cast<double>(work)) << "slabs decide here, too";
      expectTruth(seed, scale, 0.3, false, unit);
      expectTruth(seed, scale, 4.0, false, unit);
    }
    if (testing::Test::HasFailure()) return;
  }
}

} // namespace
} // namespace pcl_bsh
