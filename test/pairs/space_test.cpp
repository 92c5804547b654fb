// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/traversal/space.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace pcl_bsh {
namespace {

TEST(FrameTable, KeepsEachFrameAsItGrows)
{
  std::vector<Point3> points;
  for (int i = 0; i < 20; ++i) points.push_back({1.0 * i + 0.5, 0, 0});
  const test::Cloud cloud(points);
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  const SphereHierarchy a(cloud.view(), options), b(cloud.view(), options);
  const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0.25, 0));
  const Placed placed_a(a), placed_b(b, pose);
  const Spaces of_a(placed_a), of_b(placed_b);
  ASSERT_EQ(of_a.storage.voxel_count, 20u);
  FrameTable table(of_a, of_b);
  std::vector<const RelativeFrame*> found;
  for (std::uint32_t i = 0; i < 20; ++i)
    for (std::uint32_t k = 0; k < 20; ++k) found.push_back(&table.find(i, k));
  EXPECT_EQ(std::set<const RelativeFrame*>(found.begin(), found.end()).size(), 400u);
  for (std::uint32_t i = 0; i < 20; ++i)
    for (std::uint32_t k = 0; k < 20; ++k) {
      ASSERT_EQ(&table.find(i, k), found[20 * i + k]) << "it is made once";
      const RelativeFrame own(of_a.frame(i), placed_a.pose, of_b.frame(k), placed_b.pose);
      EXPECT_EQ(table.find(i, k).g, own.g);
    }
}

} // namespace
} // namespace pcl_bsh
