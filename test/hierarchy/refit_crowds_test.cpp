// SPDX-License-Identifier: BSD-3-Clause
// Points that floats of a voxel hardly tell apart have spheres as given, and these have to follow them, too.
#include <pcl_bsh/hierarchy/storage.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

/// Points at distances between 2^-33 and 2^-24 from a place, none of it shared by more than 16.
std::vector<Point3> crowdAt(const Point3& place, std::size_t count, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Point3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double apart = std::exp2(random.uniform(-33, -24));
    const Point3 d = random.point([&] { return apart * random.uniform(-1, 1); });
    points.push_back({place[0] + d[0], place[1] + d[1], place[2] + d[2]});
  }
  return points;
}

/// A crowd and what is around it in the same voxel.
std::vector<Point3> sceneWith(const std::vector<Point3>& crowd)
{
  Random random(1);
  std::vector<Point3> points = crowd;
  for (int i = 0; i < 60; ++i) points.push_back(random.point([&] { return random.uniform(-1, 1); }));
  points.push_back({-1, -1, -1});
  points.push_back({1, 1, 1});
  return points;
}

TEST(HierarchyRefit, OfACrowdThatMovesOntoAnother)
{
  const Point3 here = {0.25, 0.25, 0.25}, there = {0.5, -0.25, 0.125};
  HierarchyOptions one_voxel;
  one_voxel.voxel_edge = 4.0;
  const Cloud before(sceneWith(crowdAt(here, 200, 2)), {Scalar::float64, 0, 0});
  const Cloud after(sceneWith(crowdAt(there, 200, 2)), {Scalar::float64, 0, 0});
  const Cloud other(sceneWith(crowdAt(there, 200, 3)), {Scalar::float64, 0, 0});
  SphereHierarchy moving(before.view(), one_voxel), resting(other.view(), one_voxel);
  moving.buildAll();
  resting.buildAll();
  bool has_given_spheres = false;
  for (std::size_t v = 0; v < moving.storage().voxel_count; ++v)
    has_given_spheres = has_given_spheres || !moving.storage().voxels[v].given.empty();
  ASSERT_TRUE(has_given_spheres);
  EXPECT_FALSE(moving.refit(after.view(), 1e6).sorted_anew);
  EXPECT_TRUE(moving.validate().none());
  for (const double clearance : {0x1p-31, 0x1p-28, 0x1p-26}) {
    SCOPED_TRACE(clearance);
    FlagsRequest request;
    request.clearance = clearance;
    request.flagged = Flagged::both;
    const FlagsResult found = collisionFlags(moving, resting, request),
                      truth = brute_force::collisionFlags(moving, resting, request);
    EXPECT_GT(truth.colliding_a, 20u);
    EXPECT_EQ(found.a, truth.a);
    EXPECT_EQ(found.b, truth.b);
    AnyRequest any;
    any.clearance = clearance;
    EXPECT_EQ(anyCollision(moving, resting, any).verdict, Verdict::colliding);
  }
  const DistanceResult found = closestPair(moving, resting), truth = brute_force::closestPair(moving, resting);
  EXPECT_EQ(found.distance, truth.distance);
  EXPECT_EQ(found.pair, truth.pair);
}

} // namespace
} // namespace pcl_bsh
