// SPDX-License-Identifier: BSD-3-Clause
// Hierarchies whose voxels are octrees, as in the paper.
#include <pcl_bsh/hierarchy/storage.h>

#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Shape;

HierarchyOptions octants(double voxel_edge = 0.0)
{
  HierarchyOptions options;
  options.voxel_edge = voxel_edge;
  options.cells = CellSplit::octants;
  return options;
}

void expectSound(const SphereHierarchy& hierarchy)
{
  const HierarchyDefects defects = hierarchy.validate();
  EXPECT_TRUE(defects.none()) << testing::PrintToString(defects.lines);
}

TEST(Octants, DivideACubeInEight)
{
  std::vector<Point3> points;
  for (int corner = 0; corner < 8; ++corner)
    for (int i = 0; i < 20; ++i) {
      const auto at = [&](int axis) { return (corner >> axis & 1) != 0 ? 7.0 : 1.0; };
      points.push_back({at(0) + i / 64.0, at(1), at(2)});
    }
  const Cloud cloud(points);
  const SphereHierarchy hierarchy(cloud.view(), octants(8));
  hierarchy.buildAll();
  const SphereHierarchy::Storage& storage = hierarchy.storage();
  ASSERT_EQ(storage.voxel_count, 1u);
  const std::vector<Node>& nodes = storage.voxels[0].nodes;
  ASSERT_EQ(nodes.size(), 9u); // the cube, and a tree of two leaves in each octant
  EXPECT_EQ(nodes[0].count, 8u);
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(nodes[0].points(i), 20u);
    EXPECT_EQ(nodes[nodes[0].child[i]].count, 2u);
    EXPECT_EQ(nodes[0].x[i] > 0.0f, (i & 1) != 0) << i;
    EXPECT_EQ(nodes[0].y[i] > 0.0f, (i & 2) != 0) << i;
    EXPECT_EQ(nodes[0].z[i] > 0.0f, (i & 4) != 0) << i;
  }
  expectSound(hierarchy);
}

TEST(Octants, AreSoundInEveryShapeSizeAndScale)
{
  Random random(71);
  for (const Shape shape : test::all_shapes)
    for (const std::size_t count : {1u, 16u, 17u, 128u, 129u, 300u, 5000u})
      for (const double scale : {0x1p-60, 1.0, 0x1p60}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(shape) << ' ' << count << ' ' << scale);
        const Cloud cloud(test::makePoints(shape, count, scale, random));
        expectSound(SphereHierarchy(cloud.view(), octants()));
      }
}

TEST(Octants, AreSoundInVoxelsFarLargerThanTheCloud)
{
  Random random(72);
  const Cloud cloud(test::makePoints(Shape::sphere, 3000, 1, random));
  for (const double edge : {1e3, 1e30, 1e300}) expectSound(SphereHierarchy(cloud.view(), octants(edge)));
  // In the unit of so small a cloud the edge overflows; an outlier makes such a voxel, too.
  const Cloud tiny(test::makePoints(Shape::sphere, 300, 1e-150, random), {Scalar::float64});
  for (const double edge : {1e150, 1e300}) expectSound(SphereHierarchy(tiny.view(), octants(edge)));
}

TEST(Octants, HoldManyPointsOfOnePlace)
{
  std::vector<Point3> points(5000, Point3{0.3, 0.4, 0.5});
  for (int i = 0; i < 500; ++i) points.push_back({0.3 + 1e-9 * i, 0.4, 0.5});
  const Cloud cloud(points, {Scalar::float64});
  expectSound(SphereHierarchy(cloud.view(), octants()));
}

TEST(Octants, FollowPointsOutOfTheirVoxels)
{
  Random random(73);
  std::vector<Point3> points = test::makePoints(Shape::uniform, 5000, 0.2, random);
  for (Point3& p : points)
    for (double& x : p) x += 0.25; // all in one voxel
  const Cloud before(points);
  SphereHierarchy hierarchy(before.view(), octants(0.5));
  hierarchy.buildAll();
  std::reverse(points.begin(), points.end());
  for (Point3& p : points)
    for (double& x : p) x += 0.3;
  const Cloud after(points);
  const RefitReport report = hierarchy.refit(after.view()); // leaves are loose, the voxel is where it was in the grid
  ASSERT_FALSE(report.sorted_anew);
  ASSERT_EQ(report.voxels_dropped, 1u);
  expectSound(hierarchy);
}

} // namespace
} // namespace pcl_bsh
