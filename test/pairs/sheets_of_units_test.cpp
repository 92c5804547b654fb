// SPDX-License-Identifier: BSD-3-Clause
// Sheets that face each other, turned, so small or so large that their voxels measure in other units: in one, or each
// in its own. Slabs, which decide there, are in these units.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/storage.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

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
    // However a square of this size is turned, it extends between 1 and 2 along some axis: that has one unit.
    const double x = random.uniform(-1.25, 1.25), y = random.uniform(-1.25, 1.25);
    points.push_back({size * x, size * y, height + 0.02 * size * x * y + thickness * random.uniform(-1, 1)});
  }
  return points;
}

double unitOf(const SphereHierarchy& hierarchy)
{
  return hierarchy.storage().voxels[0].frame.unit;
}

/// Two sheets that face each other, each turned in its own frame.
class Sheets {
public:
  /// @param of_b the second sheet's size times `scale`, the first one's is `scale` @param gap between them, times
  /// `scale`
  Sheets(std::size_t count, std::uint64_t seed, double scale, double of_b, double gap)
  : random_(seed),
    place_(random_.pose(scale)),
    turn_(random_.rotation()),
    middle_(Eigen::Vector3d::Constant(16 * scale)),
    one_(turned(Eigen::Matrix3d::Identity(), sheet(count, scale, 0, 0.1 * gap * scale, random_)), kDoubles),
    two_(turned(turn_, sheet(count, of_b * scale, gap * scale, 0.1 * gap * scale, random_)), kDoubles),
    a_(one_.view(), voxelsOf(32 * scale)),
    b_(two_.view(), voxelsOf(32 * scale))
  {
  }

  Placed a() const { return {a_, place_ * Eigen::Translation3d(-middle_)}; }
  Placed b() const { return {b_, place_ * Eigen::Isometry3d(turn_.transpose()) * Eigen::Translation3d(-middle_)}; }

private:
  static constexpr test::Layout kDoubles = {Scalar::float64, 0, 0};

  static HierarchyOptions voxelsOf(double edge)
  {
    HierarchyOptions options;
    options.voxel_edge = edge;
    return options;
  }

  /// About the middle of a voxel.
  std::vector<Point3> turned(const Eigen::Matrix3d& turn, std::vector<Point3> points) const
  {
    for (Point3& p : points) {
      const Eigen::Vector3d at = turn * Eigen::Vector3d(p[0], p[1], p[2]) + middle_;
      p = {at[0], at[1], at[2]};
    }
    return points;
  }

  Random random_;
  Eigen::Isometry3d place_;
  Eigen::Matrix3d turn_;
  Eigen::Vector3d middle_;
  Cloud one_, two_;
  SphereHierarchy a_, b_;
};

/// @return whether both are measured in one unit
bool expectTruth(std::uint64_t seed, double scale, double of_b)
{
  const Sheets sheets(600, seed, scale, of_b, 0.04 * std::min(1.0, of_b));
  const Placed at_a = sheets.a(), at_b = sheets.b();
  EXPECT_EQ(at_a.hierarchy().storage().voxel_count, 1u);
  EXPECT_EQ(at_b.hierarchy().storage().voxel_count, 1u);
  EXPECT_EQ(unitOf(at_a.hierarchy()) == 1.0, scale == 1.0);
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
  }
  return unitOf(at_a.hierarchy()) == unitOf(at_b.hierarchy());
}

TEST(SheetsOfUnits, AnyAndClosestAreAsBruteForceSays)
{
  std::size_t mixed = 0; // pairs of voxels of different units
  for (std::uint64_t seed = 0; seed < 8; ++seed)
    for (const double scale : {1.0, 0x1p-33, 0x1p-60, 0x1p-200, 0x1p62, 0x1p100}) {
      SCOPED_TRACE(std::to_string(seed) + ", scale 2^" + std::to_string(std::ilogb(scale)));
      for (const double of_b : {1.0, 0.3, 4.0}) mixed += expectTruth(seed, scale, of_b) ? 0 : 1;
      if (testing::Test::HasFailure()) return;
    }
  EXPECT_EQ(mixed, 8u * 5u * 2u);
}

/// Spheres of such sheets overlap long before the sheets meet.
TEST(SheetsOfUnits, SlabsDecideInAnyUnit)
{
  const auto workAt = [](double scale) {
    const Sheets sheets(6000, 1, scale, 1.0, 0.005);
    AnyRequest request;
    request.clearance = 0.001 * scale;
    const AnyResult found = anyCollision(sheets.a(), sheets.b(), request);
    EXPECT_EQ(found.verdict, Verdict::free);
    return static_cast<double>(found.work.node_pairs);
  };
  const double usual = workAt(1.0);
  for (const double scale : {0x1p-33, 0x1p-60, 0x1p-200, 0x1p62, 0x1p100})
    EXPECT_LT(workAt(scale), 2 * usual) << "scale 2^" << std::ilogb(scale);
}

} // namespace
} // namespace pcl_bsh
