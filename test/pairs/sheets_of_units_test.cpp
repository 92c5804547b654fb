// SPDX-License-Identifier: BSD-3-Clause
// Sheets that face each other, turned, so small or so large that their voxels measure in other units: in one, or each
// in its own. Slabs, which decide there, are in these units.
#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/roadmap/brute_force.h>

#include "support/random_clouds.h"

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

struct Truth {
  std::uint64_t work = 0; ///< of the first pair found, or of none
  double unit_a = 1.0, unit_b = 1.0;
};

/// @param of_b the second sheet's size, the first one's is 1
Truth expectTruth(std::uint64_t seed, double scale, double of_b)
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
  Truth result{0, unitOf(a), unitOf(b)};
  const DistanceResult truth = brute_force::closestPair(at_a, at_b);
  const DistanceResult found = closestPair(at_a, at_b);
  EXPECT_EQ(found.distance, truth.distance);
  EXPECT_EQ(found.pair, truth.pair);
  const double d = truth.distance; // rounded
  for (const double clearance : {0.5 * d, std::nextafter(d, 0.0), std::nextafter(d, 2 * d), 1.5 * d}) {
    AnyRequest request;
    request.clearance = clearance;
    const AnyResult any = anyCollision(at_a, at_b, request);
    EXPECT_EQ(any.verdict, clearance < d ? Verdict::free : Verdict::colliding) << clearance / d;
    if (clearance == 0.5 * d) result.work = any.work.node_pairs;
  }
  return result;
}

TEST(SheetsOfUnits, AnyAndClosestAreAsBruteForceSays)
{
  std::size_t mixed = 0; // pairs of voxels of different units
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Truth usual = expectTruth(seed, 1.0, 1.0);
    EXPECT_EQ(usual.unit_a, 1.0);
    for (const double scale : {0x1p-33, 0x1p-60, 0x1p-200, 0x1p62, 0x1p100}) {
      SCOPED_TRACE(std::to_string(seed) + ", scale 2^" + std::to_string(std::ilogb(scale)));
      const Truth scaled = expectTruth(seed, scale, 1.0);
      EXPECT_NE(scaled.unit_a, 1.0);
      EXPECT_LT(static_cast<double>(scaled.work), 3.0 * static_cast<double>(usual.work)) << "slabs decide here, too";
      for (const double of_b : {0.3, 4.0}) {
        const Truth other = expectTruth(seed, scale, of_b);
        mixed += other.unit_a != other.unit_b ? 1 : 0;
      }
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(mixed, 40U);
}

} // namespace
} // namespace pcl_bsh
