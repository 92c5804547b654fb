// SPDX-License-Identifier: BSD-3-Clause
// Whatever edge is asked for, and however far points reach: memory and work stay proportional to the points.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/neighbors/neighbors.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <cmath>

namespace pcl_bsh::test {
namespace {

constexpr double kMostBytesPerPoint = 100.0;

HierarchyOptions edgeOf(double edge, unsigned threads = 1)
{
  HierarchyOptions options;
  options.voxel_edge = edge;
  options.threads = threads;
  return options;
}

std::size_t mostVoxels(std::size_t points)
{
  return std::max<std::size_t>(4096, points / 16);
}

TEST(VoxelEdge, TooFineForThePointsIsMadeCoarser)
{
  Random random(1);
  const std::size_t count = 200'000;
  const Cloud cloud(makePoints(Shape::uniform, count, 1.0, random), Layout{Scalar::float64, 0, 0});
  for (const double edge : {1e-300, 1e-3, 0.01}) {
    const SphereHierarchy hierarchy(cloud.view(), edgeOf(edge));
    hierarchy.buildAll();
    const HierarchyStatistics statistics = hierarchy.statistics();
    EXPECT_LE(statistics.voxels, mostVoxels(count)) << edge;
    EXPECT_GT(8.5 * static_cast<double>(statistics.voxels), static_cast<double>(mostVoxels(count))) << "not by more";
    EXPECT_LE(static_cast<double>(statistics.bytes), kMostBytesPerPoint * static_cast<double>(count)) << edge;
    EXPECT_EQ(statistics.requested_voxel_edge, edge);
    EXPECT_GT(statistics.voxel_edge, edge);
    EXPECT_EQ(std::exp2(std::round(std::log2(statistics.voxel_edge))), statistics.voxel_edge);
  }
}

TEST(VoxelEdge, ThatSuitsThePointsIsKept)
{
  Random random(2);
  const Cloud cloud(makePoints(Shape::uniform, 3000, 1.0, random));
  const HierarchyStatistics fine = SphereHierarchy(cloud.view(), edgeOf(0x1p-10)).statistics();
  EXPECT_EQ(fine.voxel_edge, 0x1p-10); // nearly a voxel for each point: so few may
  EXPECT_GT(fine.voxels, 2500u);
  const HierarchyStatistics chosen = SphereHierarchy(cloud.view()).statistics();
  EXPECT_EQ(chosen.requested_voxel_edge, 0.0);
  EXPECT_GT(chosen.voxel_edge, 0.0);
}

TEST(VoxelEdge, IsTheSameForAnyNumberOfThreads)
{
  Random random(3);
  std::vector<Point3> points = makePoints(Shape::plane, 300'000, 1.0, random);
  points[170'003] = {40.0, 3.0, -7.0}; // outside of what a sample tells
  const Cloud cloud(points);
  for (const double edge : {0x1p-14, 0x1p-9, 0x1p-7, 0x1p-6}) {
    const SphereHierarchy one(cloud.view(), edgeOf(edge, 1)), two(cloud.view(), edgeOf(edge, 2));
    EXPECT_EQ(one.statistics().voxel_edge, two.statistics().voxel_edge) << edge;
    EXPECT_EQ(one.statistics().voxels, two.statistics().voxels) << edge;
    Neighbors of_one, of_two;
    Work work_one, work_two;
    radiusSearch(one, {0.1, 0.1, 0.0}, 0.1, of_one, {}, &work_one);
    radiusSearch(two, {0.1, 0.1, 0.0}, 0.1, of_two, {}, &work_two);
    EXPECT_EQ(of_one.indices, of_two.indices);
    EXPECT_EQ(work_one.node_pairs, work_two.node_pairs) << edge;
  }
}

/// One voxel for all points, and clouds that reach from denormals to the largest numbers.
TEST(VoxelEdge, AnswersAreRightWhateverItIs)
{
  Random random(4);
  std::vector<Point3> wide;
  for (int i = 0; i < 300; ++i)
    wide.push_back(random.point([&] { return std::ldexp(random.uniform(-1, 1), random.integer(-1070, 1020)); }));
  std::vector<Point3> mixed = makePoints(Shape::uniform, 300, 1.0, random);
  for (std::size_t i = 0; i < 10; ++i) mixed[i * 29][i % 3] = std::ldexp(1.0, 100 * static_cast<int>(i));
  for (const auto* points : {&wide, &mixed}) {
    const Cloud cloud(*points, Layout{Scalar::float64, 0, 0});
    const Cloud other(makePoints(Shape::uniform, 50, 1.0, random), Layout{Scalar::float64, 0, 0});
    const SphereHierarchy b(other.view());
    FlagsRequest request;
    request.clearance = 0.25;
    request.flagged = Flagged::both;
    for (const double edge : {0.0, 1e-308, 1e-3, 1.0, 1e30, 1e308}) {
      const SphereHierarchy a(cloud.view(), edgeOf(edge));
      EXPECT_THAT(a.validate().lines, testing::IsEmpty()) << edge;
      const FlagsResult found = collisionFlags({a}, {b}, request),
                        right = brute_force::collisionFlags({a}, {b}, request);
      EXPECT_EQ(found.a, right.a) << edge;
      EXPECT_EQ(found.b, right.b) << edge;
    }
  }
}

TEST(VoxelEdge, FarTooCoarseCostsNoMoreThanItsPoints)
{
  Random random(5);
  const std::size_t count = 100'000;
  const Cloud cloud(makePoints(Shape::sphere, count, 1.0, random));
  const SphereHierarchy fitting(cloud.view()), coarse(cloud.view(), edgeOf(1e9));
  fitting.buildAll();
  coarse.buildAll();
  EXPECT_LE(coarse.statistics().voxels, 8u);
  EXPECT_LE(coarse.statistics().bytes, 2 * fitting.statistics().bytes);
  Work of_fitting, of_coarse;
  Neighbors found;
  for (std::uint32_t i = 0; i < count; i += 997) {
    nearestKSearch(fitting, cloud.view().point(i), 8, found, &of_fitting);
    nearestKSearch(coarse, cloud.view().point(i), 8, found, &of_coarse);
  }
  EXPECT_LE(of_coarse.node_pairs + of_coarse.leaf_pairs, 3 * (of_fitting.node_pairs + of_fitting.leaf_pairs));
}

} // namespace
} // namespace pcl_bsh::test
