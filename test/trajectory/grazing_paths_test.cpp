// SPDX-License-Identifier: BSD-3-Clause
// Long bodies which pass surfaces at about the clearance, on paths that intervals may follow far: all poses that a
// short cut takes together, against brute force.
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/allocations.h"
#include "support/journeys.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::everything;
using test::expectSame;
using test::flagsOnly;
using test::Poses;
using test::Random;
using testing::NanSensitiveFloatEq;
using testing::Pointwise;

using Cloud = std::vector<Eigen::Vector3d>;

constexpr double kClearance = 0.05;
constexpr double kNoise = 0.006;

PointsView viewOf(const Cloud& cloud)
{
  return pcl_bsh::viewOf(cloud.front().data(), cloud.size());
}

Eigen::Vector3d noise(Random& random)
{
  return kNoise * Eigen::Vector3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// The shortest turn of x into an axis. (Eigen's FromTwoVectors() takes a compiler six seconds.)
Eigen::Quaterniond turnToward(const Eigen::Vector3d& axis)
{
  const Eigen::Vector3d to = axis.normalized();
  return Eigen::Quaterniond(1 + to.x(), 0, -to.z(), to.y()).normalized();
}

/// The side of a body 8 m long, with an edge, along an axis of its own.
Cloud bodyAlong(const Eigen::Vector3d& axis, Random& random)
{
  const Eigen::Quaterniond turn = turnToward(axis);
  Cloud body;
  for (int i = 0; i < 250; ++i) {
    const double along = random.uniform(-4, 4), down = random.uniform(0, 0.4);
    body.push_back(turn * Eigen::Vector3d(along, i % 2 == 0 ? 0.0 : -down, i % 2 == 0 ? -down : 0.5 * down) +
                   noise(random));
  }
  return body;
}

/// Places which points of the body's edge pass at about the clearance: beside it at poses picked at random.
Cloud wallBeside(const Poses& poses, const Eigen::Vector3d& axis, Random& random)
{
  const Eigen::Quaterniond turn = turnToward(axis);
  Cloud wall;
  for (int i = 0; i < 160; ++i) {
    const Eigen::Isometry3d& pose =
        poses[static_cast<std::size_t>(random.integer(0, static_cast<int>(poses.size()) - 1))];
    const double gap = kClearance + random.uniform(-0.02, 0.03);
    wall.push_back(pose * (turn * Eigen::Vector3d{random.uniform(-4, 4), gap, random.uniform(-0.2, 0.1)}) +
                   noise(random));
  }
  return wall;
}

struct GrazingPath {
  std::string name;
  std::function<Eigen::Isometry3d(int k, Random& random)> pose;
};

Eigen::Isometry3d placed(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& at)
{
  Eigen::Isometry3d pose(Eigen::AngleAxisd(angle, axis.normalized()));
  pose.translation() = at;
  return pose;
}

/// A pose on a bend of radius r in the plane, heading along it.
Eigen::Isometry3d onBend(double radius, double way, double rise = 0.0)
{
  const double angle = way / radius;
  return placed(angle, Eigen::Vector3d::UnitZ(),
                {radius * std::sin(angle), radius * (1 - std::cos(angle)), rise * angle});
}

std::vector<GrazingPath> grazingPaths()
{
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  return {
      {"straight", [=](int k, Random&) { return placed(0, z, 0.1 * k * x); }},
      {"a bend", [](int k, Random&) { return onBend(180, 0.1 * k); }},
      {"a narrow bend", [](int k, Random&) { return onBend(3, 0.05 * k); }},
      {"a helix", [](int k, Random&) { return onBend(6, 0.1 * k, 2.0); }},
      {"bends to both sides",
       [=](int k, Random&) {
         return placed(0.05 * std::cos(0.05 * k), z, {0.1 * k, 0.1 * std::sin(0.05 * k), 0});
       }},
      {"uneven steps", [](int k, Random&) { return onBend(60, 0.002 * k * k); }},
      {"repeated poses", [](int k, Random&) { return onBend(40, 0.4 * (k / 5)); }},
      {"a jump", [](int k, Random&) { return onBend(90, 0.1 * k + (k > 70 ? 30 : 0)); }},
      {"on the spot",
       [=](int k, Random&) {
         return placed(0.01 * k, z, {1, 2, 3});
       }},
      {"full turns", [=](int k, Random&) { return placed(0.3 * k, x + 0.1 * y, 0.01 * k * x); }},
      {"there and back", [](int k, Random&) { return onBend(50, 0.1 * (k < 50 ? k : 100 - k)); }},
      {"far away", [](int k, Random&) { return Eigen::Translation3d(4e5, -3e6, 100) * onBend(180, 0.1 * k); }},
      {"not quite rigid",
       [](int k, Random& random) {
         Eigen::Isometry3d pose = onBend(180, 0.1 * k);
         pose.linear() *= 1.0 + random.uniform(-2e-7, 2e-7);
         return pose;
       }},
      {"trembling", [](int k, Random& random) { return onBend(180, 0.1 * k) * Eigen::Translation3d(noise(random)); }},
  };
}

TEST(GrazingPaths, AnswerAsBruteForce)
{
  std::uint64_t seed = 0;
  for (const GrazingPath& path : grazingPaths())
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0.3)}) {
      SCOPED_TRACE(path.name);
      Random random(++seed);
      Poses poses;
      for (int k = 0; k < 100; ++k) poses.push_back(path.pose(k, random));
      for (Eigen::Isometry3d& pose : poses) // the body heads along its way
        pose.rotate(turnToward(axis).conjugate());
      const Cloud body = bodyAlong(axis, random), wall = wallBeside(poses, axis, random);
      const SphereHierarchy scan(viewOf(wall)), model(viewOf(body));
      const TrajectoryResult expected = brute_force::collideAlong({scan}, model, poses, everything(kClearance));
      EXPECT_GT(expected.colliding, 5u);
      EXPECT_LT(expected.colliding, wall.size());
      expectSame(collideAlong({scan}, model, poses, everything(kClearance)), expected);
      EXPECT_EQ(collideAlong({scan}, model, poses, flagsOnly(kClearance)).flags, expected.flags);
      TrajectoryRequest first = flagsOnly(kClearance);
      first.first_poses = true;
      first.threads = 2;
      EXPECT_EQ(collideAlong({scan}, model, poses, first).first_pose, expected.first_pose);
      // Swept: what collides at a pose collides, too.
      TrajectoryRequest swept = flagsOnly(kClearance);
      swept.swept = 0.01;
      const TrajectoryResult moved = collideAlong({scan}, model, poses, swept);
      for (std::size_t i = 0; i < wall.size(); ++i) EXPECT_GE(moved.flags[i], expected.flags[i]) << i;
      // Where each point's first contact is asked for, the first one of all does not end the search for a point.
      swept.first_poses = swept.distances = true;
      const TrajectoryResult each = collideAlong({scan}, model, poses, swept);
      EXPECT_EQ(each.flags, moved.flags);
      EXPECT_EQ(each.first_contact->pose, moved.first_contact->pose);
      EXPECT_EQ(each.first_contact->fraction, moved.first_contact->fraction);
      // Where no distance is asked for, what a point meets after its first contact is left out.
      swept.distances = false;
      const TrajectoryResult firsts = collideAlong({scan}, model, poses, swept);
      EXPECT_EQ(firsts.flags, each.flags);
      EXPECT_EQ(firsts.first_pose, each.first_pose);
      swept.distances = true;
      swept.first_poses = false;
      const TrajectoryResult measured = collideAlong({scan}, model, poses, swept);
      EXPECT_EQ(measured.flags, moved.flags);
      EXPECT_EQ(measured.first_contact->fraction, moved.first_contact->fraction);
      EXPECT_THAT(measured.distance, Pointwise(NanSensitiveFloatEq(), each.distance));
    }
}

/// Points take few looks at single poses, with or without summaries of these.
TEST(GrazingPaths, AskedAboutPointsTakeNoMoreLooksThanAboutPoses)
{
  Random random(3);
  Cloud wall, side;
  for (int i = 0; i < 4000; ++i) wall.push_back({random.uniform(-4, 4), 0.0, random.uniform(0, 0.3)});
  for (int i = 0; i < 4000; ++i) side.push_back({random.uniform(-2, 2), 0.045, random.uniform(0, 0.3)});
  for (Cloud* cloud : {&wall, &side})
    for (Eigen::Vector3d& p : *cloud) p += noise(random);
  Poses poses;
  for (int k = 0; k < 300; ++k) poses.push_back(placed(1e-4 * k, Eigen::Vector3d::UnitZ(), {0.02 * k - 3, 0, 0}));
  const SphereHierarchy scan(viewOf(wall)), model(viewOf(side));
  TrajectoryRequest request = everything(kClearance);
  const TrajectoryResult summed = collideAlong({scan}, model, poses, request);
  request.pose_summaries = false;
  const TrajectoryResult found = collideAlong({scan}, model, poses, request);
  EXPECT_GT(found.colliding, 1000u);
  EXPECT_LT(found.work.leaf_pairs, summed.work.leaf_pairs);
  EXPECT_THAT(found.distance, Pointwise(NanSensitiveFloatEq(), summed.distance));
  EXPECT_EQ(found.first_pose, summed.first_pose);
  EXPECT_EQ(found.closest_pose, summed.closest_pose);
  EXPECT_EQ(found.closest_point, summed.closest_point);
  request.distances = request.closest_poses = false;
  const TrajectoryResult first = collideAlong({scan}, model, poses, request);
  EXPECT_LT(4 * first.work.leaf_pairs, found.work.leaf_pairs);
  EXPECT_EQ(first.first_pose, summed.first_pose);
}

/// Around each point of the scan, points of the model at just the clearance, all along a path that floats hardly see:
/// each pair has to be compared at each pose. Little is kept of them until then.
TEST(GrazingPaths, PassManyPointsAtTheClearance)
{
  constexpr int kAround = 150;
  Cloud points, around;
  for (int i = 0; i < 16; ++i) points.push_back(Eigen::Vector3d(i % 4, i / 4, 0));
  for (const Eigen::Vector3d& p : points)
    for (int i = 0; i < kAround; ++i) {
      const double z = 1 - (2 * i + 1.0) / kAround, across = std::sqrt(1 - z * z), angle = 2.4 * i;
      around.push_back(p + 0.25 * Eigen::Vector3d(across * std::cos(angle), across * std::sin(angle), z));
    }
  Poses poses;
  for (int k = 0; k < 150; ++k) poses.push_back(placed(0, Eigen::Vector3d::UnitZ(), {1e-9 * k, 0, 0}));
  const SphereHierarchy scan(viewOf(points)), model(viewOf(around));
  const double clearance = 0.25 + 0.5e-7;
  test::takeLargestAllocation();
  const TrajectoryResult found = collideAlong({scan}, model, poses, everything(clearance));
  EXPECT_LT(test::takeLargestAllocation(), std::size_t{1} << 20);
  EXPECT_GT(found.work.leaf_pairs, std::size_t{3} << 14); // several times what is kept
  std::vector<float> nearest(points.size(), std::numeric_limits<float>::infinity());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const TrajectoryResult at = collideAlong({scan}, model, {poses[k]}, everything(clearance));
    EXPECT_EQ(found.poses[k].colliding_points, at.poses[0].colliding_points) << k;
    EXPECT_EQ(found.poses[k].distance, at.poses[0].distance) << k;
    for (std::size_t i = 0; i < points.size(); ++i) nearest[i] = std::fmin(nearest[i], at.distance[i]);
  }
  EXPECT_EQ(found.distance, nearest);
}

} // namespace
} // namespace pcl_bsh
