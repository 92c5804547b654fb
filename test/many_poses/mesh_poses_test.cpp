// SPDX-License-Identifier: BSD-3-Clause
// Triangles at many poses, and on many motions.
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>

#include "support/brute_force/many_poses.h"
#include "support/journeys.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace pcl_bsh {
namespace {

using test::anyMeshJourney;
using test::Journey;

TEST(TrianglesAtPoses, AgreeWithBruteForce)
{
  std::size_t colliding = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const Journey run = anyMeshJourney(seed, 30, 10);
    SCOPED_TRACE(run.name);
    const SphereHierarchy a(run.scene.a.view()), b(run.scene.b.view());
    const Placed placed{a, run.scene.pose_a};
    AnyRequest any;
    any.clearance = run.scene.clearance;
    const AnyAtPoses found = anyCollisionAtPoses(placed, b, run.poses, any);
    const AnyAtPoses truth = brute_force::anyCollisionAtPoses(placed, b, run.poses, any);
    EXPECT_EQ(found.flags, truth.flags);
    const DistancesAtPoses near = closestPairAtPoses(placed, b, run.poses);
    const DistancesAtPoses nearest = brute_force::closestPairAtPoses(placed, b, run.poses);
    EXPECT_EQ(near.distances, nearest.distances);
    EXPECT_TRUE(near.pairs == nearest.pairs);
    colliding += truth.colliding;
    if (HasFailure()) return;
  }
  EXPECT_GT(colliding, 100u);
}

TEST(TrianglesOnMotions, AgreeWithBruteForce)
{
  std::size_t colliding = 0, motions_asked = 0;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    const Journey run = anyMeshJourney(seed, 12, 4);
    SCOPED_TRACE(run.name);
    const SphereHierarchy a(run.scene.a.view()), b(run.scene.b.view());
    const Placed placed{a, run.scene.pose_a};
    std::vector<PoseMotion> motions;
    for (std::uint32_t k = 0; k + 1 < run.poses.size(); ++k) motions.push_back({k, k + 1});
    MotionsRequest request;
    request.clearance = run.scene.clearance;
    request.swept = 1e-3 * (1.0 + run.scene.clearance);
    try {
      const AnyOnMotions truth = brute_force::anyCollisionOnMotions(placed, b, run.poses, motions, request);
      EXPECT_EQ(anyCollisionOnMotions(placed, b, run.poses, motions, request).flags, truth.flags);
      colliding += truth.colliding;
      motions_asked += motions.size();
    }
    catch (const std::invalid_argument&) { // half a turn, or too small a tolerance
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(colliding, 20u);
  EXPECT_GT(motions_asked, colliding);
}

} // namespace
} // namespace pcl_bsh
