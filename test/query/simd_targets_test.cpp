// SPDX-License-Identifier: BSD-3-Clause
// Equal answers and equal work on every instruction set that this machine has.
#include <pcl_bsh/collide.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/question.h"
#include "support/random_clouds.h"
#include "support/simd_target.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

struct Answers {
  AnyResult any;
  FlagsResult flags;
  DistanceResult closest;
  TrajectoryResult poses, swept;
  HierarchyStatistics statistics;
};

/// A few steps from where b stands, turning.
TrajectoryResult alongPath(const test::Scene& scene, const SphereHierarchy& a, const SphereHierarchy& b, bool swept)
{
  std::vector<Eigen::Isometry3d> poses(6, scene.pose_b);
  for (std::size_t k = 1; k < poses.size(); ++k)
    poses[k] = poses[k - 1] * Eigen::Translation3d(0.1 * scene.clearance, 0, 0) *
               Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitZ());
  TrajectoryRequest request;
  request.clearance = scene.clearance;
  request.distances = request.first_poses = request.closest_poses = true;
  if (swept) request.swept = 1.0;
  return collideAlong({a, scene.pose_a}, b, poses, request);
}

/// Everything from the points on, on one target.
Answers answersOn(std::int64_t target, const test::Scene& scene)
{
  const test::OnTarget on_target(target);
  test::Question request;
  request.clearance = scene.clearance;
  request.flagged = Flagged::both;
  const SphereHierarchy a(scene.a.view()), b(scene.b.view());
  const Placed placed_a{a, scene.pose_a}, placed_b{b, scene.pose_b};
  return {anyCollision(placed_a, placed_b, request),
          collisionFlags(placed_a, placed_b, request),
          closestPair(placed_a, placed_b, request),
          alongPath(scene, a, b, false),
          alongPath(scene, a, b, true),
          a.statistics()};
}

TEST(SimdTargets, AnswerAlike)
{
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  ASSERT_FALSE(targets.empty());
  if (targets.size() == 1) GTEST_SKIP() << "only " << hwy::TargetName(targets[0]) << " here";
  for (std::uint64_t seed = 5000; seed < 5060; ++seed) {
    const test::Scene scene = test::anyScene(seed, seed % 10 == 0 ? 3000 : 200);
    SCOPED_TRACE(scene.name);
    const Answers expected = answersOn(targets.front(), scene);
    for (const std::int64_t target : targets) {
      SCOPED_TRACE(hwy::TargetName(target));
      const Answers answers = answersOn(target, scene);
      EXPECT_EQ(answers.any.pair, expected.any.pair);
      EXPECT_EQ(answers.flags.a, expected.flags.a);
      EXPECT_EQ(answers.flags.b, expected.flags.b);
      EXPECT_EQ(answers.closest.distance, expected.closest.distance);
      EXPECT_EQ(answers.closest.pair, expected.closest.pair);
      EXPECT_EQ(answers.statistics.mean_leaf_radius, expected.statistics.mean_leaf_radius);
      for (const auto along : {&Answers::poses, &Answers::swept}) {
        EXPECT_EQ((answers.*along).flags, (expected.*along).flags);
        EXPECT_EQ((answers.*along).first_pose, (expected.*along).first_pose);
        EXPECT_EQ((answers.*along).closest_pose, (expected.*along).closest_pose);
        EXPECT_EQ((answers.*along).closest_point, (expected.*along).closest_point);
        EXPECT_EQ(test::countsOf((answers.*along).work), test::countsOf((expected.*along).work));
      }
      EXPECT_EQ(test::countsOf(answers.any.work), test::countsOf(expected.any.work));
      EXPECT_EQ(test::countsOf(answers.flags.work), test::countsOf(expected.flags.work));
      EXPECT_EQ(test::countsOf(answers.closest.work), test::countsOf(expected.closest.work));
    }
  }
}

} // namespace
} // namespace pcl_bsh
