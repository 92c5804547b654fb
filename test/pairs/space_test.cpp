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
  constexpr std::uint32_t few = 4, many = 100; // of one voxel so many that their entries lie side by side
  std::vector<Point3> points;
  for (std::uint32_t i = 0; i < many; ++i) points.push_back({i + 0.5, 0, 0});
  const test::Cloud cloud(points), part({points.begin(), points.begin() + few});
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  const SphereHierarchy a(part.view(), options), b(cloud.view(), options);
  const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0.25, 0));
  const Placed placed_a(a), placed_b(b, pose);
  const Spaces of_a(placed_a), of_b(placed_b);
  ASSERT_EQ(of_a.storage.voxel_count, few);
  ASSERT_EQ(of_b.storage.voxel_count, many);
  FrameTable table(of_a, of_b);
  std::vector<const RelativeFrame*> found;
  for (std::uint32_t i = 0; i < few; ++i)
    for (std::uint32_t k = 0; k < many; ++k) found.push_back(&table.find(i, k));
  EXPECT_EQ(std::set<const RelativeFrame*>(found.begin(), found.end()).size(), few * many);
  for (std::uint32_t i = 0; i < few; ++i)
    for (std::uint32_t k = 0; k < many; ++k) {
      ASSERT_EQ(&table.find(i, k), found[many * i + k]) << "it is made once";
      const RelativeFrame own(of_a.frame(i), placed_a.pose, of_b.frame(k), placed_b.pose);
      EXPECT_EQ(table.find(i, k).g, own.g);
    }
}

} // namespace
} // namespace pcl_bsh
