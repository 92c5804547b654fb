// SPDX-License-Identifier: BSD-3-Clause
// However the cells of voxels are divided, answers are the same.
#include <pcl_bsh/collide.h>
#include <pcl_bsh/neighbors/neighbors.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

namespace pcl_bsh {
namespace {

TEST(CellSplit, ChangesNoAnswer)
{
  HierarchyOptions octants;
  octants.cells = CellSplit::octants;
  for (std::uint64_t seed = 7000; seed < 7100; ++seed) {
    const test::Scene scene = test::anyScene(seed, seed % 10 == 0 ? 3000 : 400);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view()), octree_a(scene.a.view(), octants),
        octree_b(scene.b.view(), octants);
    const Placed placed_a{a, scene.pose_a}, placed_b{b, scene.pose_b};
    const Placed as_octree_a{octree_a, scene.pose_a}, as_octree_b{octree_b, scene.pose_b};
    FlagsRequest flags;
    flags.clearance = scene.clearance;
    flags.flagged = Flagged::both;
    const FlagsResult expected = collisionFlags(placed_a, placed_b, flags);
    const FlagsResult found = collisionFlags(as_octree_a, as_octree_b, flags);
    EXPECT_EQ(found.a, expected.a);
    EXPECT_EQ(found.b, expected.b);
    const DistanceResult nearest = closestPair(as_octree_a, as_octree_b);
    const DistanceResult expected_nearest = closestPair(placed_a, placed_b);
    EXPECT_EQ(nearest.distance, expected_nearest.distance);
    EXPECT_EQ(nearest.pair, expected_nearest.pair);
    AnyRequest any;
    any.clearance = scene.clearance;
    EXPECT_EQ(anyCollision(as_octree_a, as_octree_b, any).verdict, anyCollision(placed_a, placed_b, any).verdict);
  }
}

} // namespace
} // namespace pcl_bsh
