// SPDX-License-Identifier: BSD-3-Clause
// Where float arithmetic is at its limits: every rounding in the same direction, coordinates of every magnitude.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/brute_force/neighbors.h"
#include "support/question.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

HierarchyOptions voxels(double edge)
{
  HierarchyOptions options;
  options.voxel_edge = edge;
  return options;
}

/// A point and its mirror image in the middle of a voxel of edge 4.
struct Pair {
  explicit Pair(const Point3& p) : xyz{p[0], p[1], p[2], 4 - p[0], 4 - p[1], 4 - p[2]} {}

  std::vector<double> xyz;
  SphereHierarchy cloud{viewOf(xyz.data(), 2), voxels(4)};
};

/// Each product of the frame change is rounded five times, up every time. With four allowed for, the pair at the
/// clearance is reported free, and its image on the other side reported colliding where it is not.
TEST(FloatLimits, EveryRoundingInTheSameDirection)
{
  Eigen::Isometry3d pose = identity;
  pose.linear() << 0.9999999701976492, 0.0001726335725324467, 0.0001726335725324467, //
      -0.0001726335751048897, 0.9999999850988244, -8.8818008559676e-16,              //
      -0.00017263356996000367, -2.98023499212255e-08, 0.9999999850988248;
  pose.translation() = Eigen::Vector3d(-0.0006904151389910535, 0.00034529695256280927, 0.0003453565469702151);
  const Point3 p0 = {3.0000006556365406, 2.0003448454349684, 2.0003448454349684};
  const Pair a(p0);
  constexpr double clearance = 0.010013219883270393;
  for (const double side : {1.0, -1.0}) {
    const Point3 q0 = {side > 0 ? 3.010013997569331 : 2.990001, 2.000172211759491, 2.000172211744939};
    const Pair b(q0);
    const Placed at_a{a.cloud, pose}, at_b{b.cloud, identity};
    const double gap = ExactDistance(pose, identity).gap({p0, q0});
    for (int i = -60; i <= 60; ++i) {
      test::Question request;
      request.clearance = i == 0 && side > 0 ? clearance : gap + i * 1e-8;
      request.flagged = Flagged::both;
      const FlagsResult expected = brute_force::collisionFlags(at_a, at_b, request);
      const FlagsResult found = collisionFlags(at_a, at_b, request);
      EXPECT_EQ(found.a, expected.a) << side << " " << i;
      EXPECT_EQ(found.b, expected.b) << side << " " << i;
      EXPECT_EQ(anyCollision(at_a, at_b, request).verdict, brute_force::anyCollision(at_a, at_b, request).verdict);

      TrajectoryRequest along;
      along.clearance = request.clearance;
      along.distances = true;
      const auto passed = collideAlong(at_a, b.cloud, {identity}, along);
      const auto passed_expected = brute_force::collideAlong(at_a, b.cloud, {identity}, along);
      EXPECT_EQ(passed.flags, passed_expected.flags) << side << " " << i;
    }
  }
}

/// Decimal exponents from the smallest doubles to the largest, the limits of float among them.
std::vector<int> magnitudes()
{
  std::vector<int> all;
  for (int e = -300; e <= 300; e += std::abs(e) < 60 ? 5 : 30) all.push_back(e);
  for (const int e : {-46, -45, -38, -37, -23, -22, -19, 17, 18, 19, 25, 37, 38, 39}) all.push_back(e);
  return all;
}

void expectEqual(const Neighbors& found, const Neighbors& expected)
{
  EXPECT_EQ(found.indices, expected.indices);
  EXPECT_EQ(found.squared_distances, expected.squared_distances);
}

void expectNeighborsLikeBruteForce(const SphereHierarchy& cloud, const Point3& q, double scale)
{
  Neighbors found, expected;
  for (const std::size_t k : {1u, 3u, 11u}) {
    nearestKSearch(cloud, q, k, found);
    brute_force::nearestKSearch(cloud, q, k, expected);
    expectEqual(found, expected);
  }
  for (const double radius : {0.0, 0.3 * scale, 3 * scale, 1.0, kInfinity}) {
    EXPECT_EQ(radiusSearch(cloud, q, radius, found), brute_force::radiusSearch(cloud, q, radius, expected));
    expectEqual(found, expected);
    EXPECT_EQ(anyInRadius(cloud, q, radius), !expected.indices.empty());
    radiusSearch(cloud, q, radius, found, {5, true});
    brute_force::radiusSearch(cloud, q, radius, expected, {5, true});
    expectEqual(found, expected);
  }
  std::vector<std::int32_t> inside, expected_inside;
  const Point3 high = {q[0] + scale, q[1] + 0.5 * scale, kInfinity};
  boxSearch(cloud, q, high, inside);
  brute_force::boxSearch(cloud, q, high, expected_inside);
  EXPECT_EQ(inside, expected_inside);
}

TEST(FloatLimits, NeighborsOfEveryMagnitude)
{
  test::Random random(31);
  for (const int exponent : magnitudes()) {
    const double scale = std::pow(10.0, exponent);
    for (const double edge : {0.0, 0.25}) {
      for (const double other_scale : {1.0, 1e-12, 1e-25}) { // of every other point
        std::vector<double> xyz;
        for (int i = 0; i < 24; ++i)
          for (int k = 0; k < 3; ++k) xyz.push_back(scale * random.uniform(-1, 1) * (i % 2 == 0 ? 1.0 : other_scale));
        const SphereHierarchy cloud(viewOf(xyz.data(), xyz.size() / 3), voxels(edge * scale));
        for (int i = 0; i < 3; ++i) {
          const Point3 q = random.point([&] { return scale * random.uniform(-1, 1); });
          expectNeighborsLikeBruteForce(cloud, i == 0 ? Point3{xyz[0], xyz[1], xyz[2]} : q, scale);
        }
        ASSERT_FALSE(HasFailure()) << "magnitude 1e" << exponent << ", edge " << edge << ", others " << other_scale;
      }
    }
  }
}

TEST(FloatLimits, NearestBeyondTheRangeOfFloat)
{
  const double xyz[] = {4.64929200637239e24,   -8.8883330457866159e24, -9.5519590672781914e24,
                        6.8590042130449597e24, 8.2044994619376872e24,  -7.0712794433652732e24,
                        4.9833803481830286e24, -3.7461353247330867e24, -6.3608811074005765e24};
  const SphereHierarchy cloud(viewOf(xyz, 3));
  Neighbors found;
  nearestKSearch(cloud, {4.4188783135017001e24, 4.3177226099140988e23, 1.5489809000754008e24}, 3, found);
  EXPECT_EQ(found.indices, (std::vector<std::int32_t>{2, 1, 0}));
}

TEST(FloatLimits, EverythingIsWithinAnInfiniteRadius) // at a distance that is no double
{
  const double xyz[] = {1.7e308, 1.7e308, 1.7e308};
  const SphereHierarchy cloud(viewOf(xyz, 1));
  Neighbors found;
  EXPECT_TRUE(anyInRadius(cloud, {-1.7e308, -1.7e308, -1.7e308}, kInfinity));
  EXPECT_EQ(radiusSearch(cloud, {-1.7e308, -1.7e308, -1.7e308}, kInfinity, found), 1u);
}

/// Squares of places and of motions beyond 2^64 are no floats.
TEST(FloatLimits, TrajectoriesOfEveryMagnitude)
{
  const double origin[] = {0, 0, 0};
  const SphereHierarchy model(viewOf(origin, 1));
  for (int exponent = -140; exponent <= 120; exponent += 4) {
    const double step = std::ldexp(1.0, exponent);
    const double xyz[] = {0, 0, 0, 0, 400 * step, 0};
    const SphereHierarchy scan(viewOf(xyz, 2), voxels(1000 * step));
    std::vector<Eigen::Isometry3d> poses(101, identity);
    for (int k = 0; k <= 100; ++k) poses[static_cast<std::size_t>(k)].translation().x() = (k - 50) * step;
    TrajectoryRequest request;
    request.clearance = 8 * step;
    request.first_poses = true;
    const auto found = collideAlong({scan}, model, poses, request);
    EXPECT_EQ(found.flags, test::verdictsOf({1, 0})) << "2^" << exponent;
    EXPECT_EQ(found.first_pose, (std::vector<std::int32_t>{42, -1})) << "2^" << exponent;
  }
}

/// Distances below the resolution of floats near a voxel's origin.
TEST(FloatLimits, SpacingIsThatOfTheGivenCoordinates)
{
  for (const double gap : {1e-8, 3e-10, 1e-13}) {
    std::vector<double> xyz;
    for (int i = 0; i < 500; ++i) xyz.insert(xyz.end(), {1.0 + i * gap, 0.5, 0.25});
    xyz.insert(xyz.end(), {0.0, 0.0, 0.0});
    const Spacing spacing = spacingOf(SphereHierarchy(viewOf(xyz.data(), xyz.size() / 3), voxels(4)));
    EXPECT_NEAR(spacing.median, gap, 4e-16 + 1e-9 * gap);
    EXPECT_NEAR(spacing.wide, gap, 4e-16 + 1e-9 * gap);
  }
}

} // namespace
} // namespace pcl_bsh
