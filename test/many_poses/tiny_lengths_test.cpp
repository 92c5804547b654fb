// SPDX-License-Identifier: BSD-3-Clause
// Lists of poses of bodies whose lengths are so small that squares of them vanish.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>

#include "support/brute_force/many_poses.h"
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

/// At clearances at the distance, and on either side of it.
TEST(CollideAtPoses, OfTheSmallestLengths)
{
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    Random random(seed);
    const double scale = std::pow(10.0, random.uniform(-323, -140));
    SCOPED_TRACE(std::to_string(seed) + ", scale 1e" + std::to_string(std::log10(scale)));
    const auto points = [&] { return test::makePoints(random.pick(test::all_shapes), 40, scale, random); };
    const Cloud scan(points(), {Scalar::float64, 0, 0}), body(points(), {Scalar::float64, 0, 0});
    const SphereHierarchy a(scan.view()), b(body.view());
    std::vector<Eigen::Isometry3d> poses(12, Eigen::Isometry3d::Identity());
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (seed % 2 == 0) poses[k].rotate(random.rotation());
      const double reach = random.uniform(0, 4) * scale;
      const Point3 at = random.point([&] { return reach * random.uniform(-1, 1); });
      poses[k].translation() = Eigen::Vector3d(at[0], at[1], at[2]);
    }
    const DistancesAtPoses truth = brute_force::closestPairAtPoses(a, b, poses);
    EXPECT_EQ(closestPairAtPoses(a, b, poses).distances, truth.distances);
    for (const double clearance : {truth.distances[0], std::nextafter(truth.distances[1], 0.0), scale}) {
      AnyRequest request;
      request.clearance = clearance;
      EXPECT_EQ(anyCollisionAtPoses(a, b, poses, request).flags,
                brute_force::anyCollisionAtPoses(a, b, poses, request).flags);
    }
    if (testing::Test::HasFailure()) return;
  }
}

/// Squares that are the smallest doubles, a few of them, err by as much as they are.
TEST(CollideAtPoses, OfLengthsWhoseSquaresAreTheSmallestDoubles)
{
  HierarchyOptions one_voxel; // whose sphere is small beside its distance
  one_voxel.voxel_edge = 8.0;
  for (double x = 1.5e-162; x < 1e-161; x *= 1.04) {
    SCOPED_TRACE(x);
    const Cloud one({{0, 0, 0}, {1e-175, 0, 0}}, {Scalar::float64, 0, 0});
    const Cloud other({{x, x, x}, {x, x, x + 1e-175}}, {Scalar::float64, 0, 0});
    const SphereHierarchy a(one.view(), one_voxel), b(other.view(), one_voxel);
    const std::vector<Eigen::Isometry3d> poses(3, Eigen::Isometry3d::Identity());
    for (const double share : {0.99, 1.01}) {
      AnyRequest request;
      request.clearance = share * std::sqrt(3.0) * x;
      EXPECT_EQ(anyCollisionAtPoses(a, b, poses, request).colliding, share < 1.0 ? 0u : 3u);
    }
  }
}

} // namespace
} // namespace pcl_bsh
