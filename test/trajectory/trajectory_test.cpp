// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/journeys.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

namespace pcl_bsh {
namespace {

using test::anyJourney;
using test::bitsOf;
using test::Cloud;
using test::everything;
using test::expectSame;
using test::flagsOnly;
using test::identity;
using test::Journey;
using test::Poses;
using test::Random;

void expectSameAsBruteForce(const Journey& run)
{
  SCOPED_TRACE(run.name);
  const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
  const Placed placed{scan, run.scene.pose_a};
  const double clearance = run.scene.clearance;
  const TrajectoryResult expected = brute_force::collideAlong(placed, model, run.poses, everything(clearance));
  expectSame(collideAlong(placed, model, run.poses, everything(clearance)), expected);

  const TrajectoryResult flags = collideAlong(placed, model, run.poses, flagsOnly(clearance));
  EXPECT_EQ(flags.flags, expected.flags);
  EXPECT_EQ(flags.colliding, expected.colliding);
  TrajectoryRequest one = flagsOnly(clearance);
  one.flags = false;
  one.first_poses = true;
  EXPECT_EQ(collideAlong(placed, model, run.poses, one).first_pose, expected.first_pose);
  one.first_poses = false;
  one.distances = true;
  const TrajectoryResult distances = collideAlong(placed, model, run.poses, one);
  EXPECT_EQ(bitsOf(distances.distance), bitsOf(expected.distance));
  EXPECT_EQ(distances.closest_point, expected.closest_point);
}

TEST(Trajectory, SameAsBruteForceOnSmallClouds)
{
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    expectSameAsBruteForce(anyJourney(seed, 40, 12));
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(Trajectory, SameAsBruteForceOnManyPoses)
{
  for (std::uint64_t seed = 1000; seed < 1030; ++seed) {
    expectSameAsBruteForce(anyJourney(seed, 40, 100));
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(Trajectory, SameAsBruteForceOnLargerClouds)
{
  for (std::uint64_t seed = 2000; seed < 2010; ++seed) {
    expectSameAsBruteForce(anyJourney(seed, 400, 20));
    if (::testing::Test::HasFailure()) return;
  }
}

// --- swept ---

/// Distances of each scan point to the model, at sub-poses of the motion.
struct Samples {
  std::vector<double> times;           ///< pose and fraction
  std::vector<std::vector<double>> of; ///< [time][record]; infinity where there is no point
  std::vector<double> smallest;        ///< [record]
  double step = 0.0;                   ///< no point of the model moves farther from one time to the next
};

Samples sample(const Placed& scan, const SphereHierarchy& model, const Poses& poses, const Point3& pivot,
               std::size_t count)
{
  const auto finite = [](const PointsView& view) {
    std::vector<std::pair<std::uint32_t, Eigen::Vector3d>> points;
    for (std::size_t i = 0; i < view.size(); ++i) {
      const Point3 p = view.point(view.record(i));
      if (std::isfinite(p[0] + p[1] + p[2])) points.push_back({view.record(i), Eigen::Vector3d(p[0], p[1], p[2])});
    }
    return points;
  };
  const PointsView &a = scan.hierarchy().view(), &b = model.view();
  const auto points = finite(a), obstacles = finite(b);
  Samples samples;
  samples.smallest.assign(a.count, std::numeric_limits<double>::infinity());
  std::vector<Eigen::Vector3d> before;
  for (std::size_t s = 0; s <= count; ++s) {
    const double time = static_cast<double>(s) * static_cast<double>(poses.size() - 1) / static_cast<double>(count);
    const auto k = std::min(static_cast<std::size_t>(time), poses.size() - 1);
    const Eigen::Isometry3d pose =
        poseBetween(poses[k], poses[std::min(k + 1, poses.size() - 1)], time - static_cast<double>(k), pivot);
    samples.times.push_back(time);
    std::vector<Eigen::Vector3d> moved;
    for (const auto& [record, q] : obstacles) moved.push_back(pose * q);
    for (std::size_t i = 0; i < before.size(); ++i)
      samples.step = std::max(samples.step, (moved[i] - before[i]).norm());
    before = moved;
    std::vector<double>& row = samples.of.emplace_back(a.count, std::numeric_limits<double>::infinity());
    for (const auto& [record, p] : points) {
      const Eigen::Vector3d world = scan.pose * p;
      for (std::size_t j = 0; j < moved.size(); ++j)
        row[record] =
            std::min(row[record], (world - moved[j]).norm() - a.radius(record) - b.radius(obstacles[j].first));
      samples.smallest[record] = std::min(samples.smallest[record], row[record]);
    }
  }
  return samples;
}

void expectTrueToSamples(const Journey& run, double tolerance, const Point3& pivot, std::size_t count)
{
  SCOPED_TRACE(run.name + ", tolerance " + std::to_string(tolerance));
  const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
  const Placed placed{scan, run.scene.pose_a};
  const double clearance = run.scene.clearance;
  TrajectoryRequest request;
  request.clearance = clearance;
  request.swept = tolerance;
  request.pivot = pivot;
  request.distances = request.first_poses = request.closest_poses = true;
  const TrajectoryResult result = collideAlong(placed, model, run.poses, request);
  if (run.poses.empty()) {
    EXPECT_EQ(result.colliding, 0u);
    return;
  }
  const Samples samples = sample(placed, model, run.poses, pivot, count);
  double size = 0.0; // of coordinates: what the samples' own arithmetic errs by
  for (const Eigen::Isometry3d& pose : run.poses) size = std::max(size, pose.translation().cwiseAbs().maxCoeff());
  const double rounding = 1e-14 * (size + 1.0), between = samples.step + rounding;
  double contact = std::numeric_limits<double>::infinity();
  if (result.first_contact) contact = static_cast<double>(result.first_contact->pose) + result.first_contact->fraction;
  EXPECT_EQ(std::isfinite(contact), result.colliding > 0);
  for (std::uint32_t p = 0; p < result.flags.size(); ++p) {
    SCOPED_TRACE("point " + std::to_string(p));
    if (result.flags[p] == Verdict::free) {
      EXPECT_GT(samples.smallest[p], clearance - rounding);
      EXPECT_TRUE(std::isnan(result.distance[p]));
      EXPECT_EQ(result.first_pose[p], -1);
      continue;
    }
    EXPECT_LE(samples.smallest[p], clearance + tolerance + between);
    EXPECT_LE(std::abs(result.distance[p] - samples.smallest[p]),
              tolerance / 2 + between + 1e-6 * std::abs(result.distance[p]));
    EXPECT_GE(result.first_pose[p], 0);
    for (std::size_t s = 0; samples.times[s] < result.first_pose[p]; ++s)
      EXPECT_GT(samples.of[s][p], clearance - rounding);
  }
  if (!result.first_contact) return;
  double at_contact = std::numeric_limits<double>::infinity();
  const std::size_t k = result.first_contact->pose;
  const Poses there = {poseBetween(run.poses[k], run.poses[std::min(k + 1, run.poses.size() - 1)],
                                   result.first_contact->fraction, pivot)};
  for (const double distance : sample(placed, model, there, pivot, 1).smallest)
    at_contact = std::min(at_contact, distance);
  EXPECT_LE(at_contact, clearance + tolerance + rounding);
  for (std::size_t s = 0; s < samples.times.size(); ++s) {
    if (samples.times[s] >= contact) break;
    for (const double distance : samples.of[s]) EXPECT_GT(distance, clearance - rounding);
  }
}

TEST(TrajectorySwept, TrueToDenseSamples)
{
  for (std::uint64_t seed = 3000; seed < 3120; ++seed) {
    Journey run = anyJourney(seed, 25, 6);
    Random random(seed);
    double size = 0.0;
    for (const Eigen::Isometry3d& pose : run.poses) size = std::max(size, pose.translation().cwiseAbs().maxCoeff());
    const double tolerance = std::max(1e-9 * size, 0.2 * run.scene.clearance * random.uniform(0.01, 1) + 1e-6);
    const Point3 pivot = random.chance(0.5) || run.poses.empty() || run.scene.b.view().size() == 0
                             ? Point3{0, 0, 0}
                             : run.scene.b.view().point(run.scene.b.view().record(0));
    if (!std::isfinite(pivot[0] + pivot[1] + pivot[2])) continue;
    try {
      expectTrueToSamples(run, tolerance, pivot, seed % 10 == 0 ? 10000 : 1000);
    }
    catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("swept")) << run.name;
    }
    if (::testing::Test::HasFailure()) return;
  }
}

// --- a corridor: what is long, and mostly free ---

/// A box of points, edges along the axes, from low to high, `step` apart.
std::vector<Point3> shell(const Point3& low, const Point3& high, double step)
{
  std::vector<Point3> points;
  const auto steps = [&](std::size_t axis) { return static_cast<int>(std::lround((high[axis] - low[axis]) / step)); };
  for (int i = 0; i <= steps(0); ++i)
    for (int j = 0; j <= steps(1); ++j)
      for (int k = 0; k <= steps(2); ++k)
        if (i == 0 || j == 0 || k == 0 || i == steps(0) || j == steps(1) || k == steps(2))
          points.push_back({low[0] + step * i, low[1] + step * j, low[2] + step * k});
  return points;
}

/// Two walls along x, and some posts that reach in from them.
std::vector<Point3> corridor(double length, Random& random)
{
  std::vector<Point3> points;
  for (double x = 0; x < length; x += 0.08)
    for (double z = 0; z < 2; z += 0.08)
      for (const double y : {-1.0, 1.0}) points.push_back({x + random.uniform(-0.02, 0.02), y, z});
  for (double x = 5; x < length; x += 10)
    for (double y = 0.5; y < 1; y += 0.02) points.push_back({x, y, 1.0});
  return points;
}

Poses alongCorridor(double from, double to, std::size_t count)
{
  Poses poses;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = from + (to - from) * static_cast<double>(k) / static_cast<double>(count - 1);
    Eigen::Isometry3d pose = identity;
    pose.translation() = Eigen::Vector3d(x, 0.02 * std::sin(x), 0);
    pose.linear() = Eigen::AngleAxisd(0.05 * std::sin(0.1 * x), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    poses.push_back(pose);
  }
  return poses;
}

struct Corridor {
  Random random{4711};
  Cloud walls{corridor(60, random)};
  Cloud cart{shell({-1, -0.5, 0.2}, {1, 0.5, 1.6}, 0.05)};
};

TEST(Trajectory, SameForAnyNumberOfThreads)
{
  const Corridor corridor;
  const Poses poses = alongCorridor(2, 58, 200);
  const SphereHierarchy model(corridor.cart.view());
  for (const bool swept : {false, true}) {
    TrajectoryRequest request = everything(0.1);
    if (swept) {
      request.pose_summaries = false;
      request.swept = 0.01;
    }
    const SphereHierarchy first_scan(corridor.walls.view());
    const TrajectoryResult expected = collideAlong({first_scan}, model, poses, request);
    EXPECT_GT(expected.colliding, 0u);
    for (const unsigned threads : {2u, 4u, 0u}) {
      const SphereHierarchy scan(corridor.walls.view()), fresh(corridor.cart.view());
      request.threads = threads;
      const TrajectoryResult result = collideAlong({scan}, fresh, poses, request);
      expectSame(result, expected);
      EXPECT_EQ(result.work.node_pairs, expected.work.node_pairs);
      EXPECT_EQ(result.work.leaf_pairs, expected.work.leaf_pairs);
      EXPECT_EQ(result.work.exact_decisions, expected.work.exact_decisions);
      EXPECT_EQ(result.first_contact.has_value(), expected.first_contact.has_value());
      if (result.first_contact) {
        EXPECT_EQ(result.first_contact->pose, expected.first_contact->pose);
        EXPECT_EQ(result.first_contact->fraction, expected.first_contact->fraction);
      }
    }
  }
}

/// The corridor, the cart and its poses with all lengths by a power of two: frames have units of their own there.
TEST(Trajectory, IsTheSameAtAnyScale)
{
  Random random(4712);
  const std::vector<Point3> walls = corridor(12, random), cart = shell({-1, -0.5, 0.2}, {1, 0.5, 1.6}, 0.05);
  const auto answersAt = [&](double scale, bool swept) {
    const auto scaled = [&](std::vector<Point3> points) {
      for (Point3& p : points)
        for (double& x : p) x = static_cast<double>(static_cast<float>(x)) * scale;
      return Cloud(points, {Scalar::float64, 0, 0});
    };
    const Cloud scan_cloud = scaled(walls), model_cloud = scaled(cart);
    const SphereHierarchy scan(scan_cloud.view()), model(model_cloud.view());
    Poses poses = alongCorridor(2, 10, 60);
    for (Eigen::Isometry3d& pose : poses) pose.translation() *= scale;
    TrajectoryRequest request = flagsOnly(0.1 * scale);
    request.first_poses = true;
    if (swept) request.swept = 0.01 * scale;
    return collideAlong({scan}, model, poses, request);
  };
  for (const bool swept : {false, true}) {
    const TrajectoryResult expected = answersAt(1.0, swept);
    EXPECT_GT(expected.colliding, 0u);
    for (const double scale : {0x1p-70, 0x1p70}) {
      SCOPED_TRACE(testing::Message() << scale << (swept ? " swept" : ""));
      const TrajectoryResult found = answersAt(scale, swept);
      EXPECT_EQ(found.flags, expected.flags);
      EXPECT_EQ(found.first_pose, expected.first_pose);
    }
  }
}

/// The model is so small that its frame has a unit of its own, the scan's has not.
TEST(Trajectory, OfAModelOfAnotherUnitThanTheScans)
{
  Random random(4713);
  for (const double size : {0x1p-90, 0x1p-30}) {
    SCOPED_TRACE(size);
    const Cloud wall(test::makePoints(test::Shape::uniform, 500, 1.0, random));
    const Cloud grain(test::makePoints(test::Shape::sphere, 100, size, random));
    const SphereHierarchy scan(wall.view()), model(grain.view());
    Poses poses;
    for (int k = 0; k < 30; ++k) {
      poses.push_back(identity);
      poses.back().translation() = Eigen::Vector3d(0.05 * k - 0.7, 0.1, 0.2);
    }
    for (const double clearance : {0.05, 0.3}) {
      const TrajectoryResult expected = brute_force::collideAlong({scan}, model, poses, flagsOnly(clearance));
      EXPECT_GT(expected.colliding, 0u);
      EXPECT_EQ(collideAlong({scan}, model, poses, flagsOnly(clearance)).flags, expected.flags);
    }
  }
}

TEST(Trajectory, BuildsOnlyVoxelsThatThePathNears)
{
  const Corridor corridor;
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  const SphereHierarchy scan(corridor.walls.view(), options), model(corridor.cart.view());
  const TrajectoryResult result = collideAlong({scan}, model, alongCorridor(2, 8, 50), flagsOnly(0.1));
  EXPECT_GT(result.colliding, 0u);
  EXPECT_LT(scan.statistics().voxels_built, scan.statistics().voxels / 5);
  const SphereHierarchy untouched(corridor.walls.view(), options), fresh(corridor.cart.view());
  Eigen::Isometry3d away = identity;
  away.translation().z() = 100;
  const TrajectoryResult none = collideAlong({untouched}, fresh, Poses(20, away), flagsOnly(0.1));
  EXPECT_EQ(none.colliding, 0u);
  EXPECT_EQ(none.work.voxels_built, 0u);
  EXPECT_EQ(untouched.statistics().voxels_built + fresh.statistics().voxels_built, 0u);
}

TEST(Trajectory, WhatIsNotAskedForCostsNothing)
{
  const Corridor corridor;
  const Poses poses = alongCorridor(2, 58, 200);
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  const auto workOf = [&](const TrajectoryRequest& request) {
    return collideAlong({scan}, model, poses, request).work.leaf_pairs;
  };
  TrajectoryRequest request = flagsOnly(0.1);
  collideAlong({scan}, model, poses, request); // builds
  const TrajectoryResult flags = collideAlong({scan}, model, poses, request);
  EXPECT_TRUE(flags.distance.empty() && flags.first_pose.empty() && flags.closest_pose.empty() &&
              flags.closest_point.empty() && flags.poses.empty() && !flags.first_contact);
  EXPECT_EQ(flags.work.voxels_built, 0u);
  EXPECT_EQ(flags.work.exact_decisions, 0u) << "no tie here";
  const std::uint64_t of_flags = flags.work.leaf_pairs;
  request.first_poses = true;
  const std::uint64_t of_first = workOf(request);
  request.first_poses = false;
  request.closest_poses = true;
  const std::uint64_t of_closest = workOf(request);
  request.pose_summaries = true;
  EXPECT_LT(of_flags, of_first);
  EXPECT_LT(of_flags, of_closest);
  EXPECT_LT(of_closest, workOf(request));
  request = flagsOnly(0.1);
  request.flags = false;
  EXPECT_EQ(collideAlong({scan}, model, poses, request).work.node_pairs, 0u);
}

TEST(Trajectory, CostsLessPerPoseAsPosesGetDenser)
{
  const Corridor corridor;
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  const auto workOf = [&](std::size_t poses, const TrajectoryRequest& request) {
    const Work work = collideAlong({scan}, model, alongCorridor(2, 58, poses), request).work;
    return work.node_pairs + 20 * work.leaf_pairs;
  };
  for (const std::size_t poses : {100u, 1000u})
    EXPECT_LT(workOf(10 * poses, flagsOnly(0.1)), 3 * workOf(poses, flagsOnly(0.1))) << poses;
}

TEST(Trajectory, LargeClearancesCostLittle)
{
  const Corridor corridor;
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  const Poses poses = alongCorridor(2, 58, 200);
  for (const double clearance : {0.3, 1.0, 2.0, 10.0}) {
    const TrajectoryResult result = collideAlong({scan}, model, poses, flagsOnly(clearance));
    EXPECT_LT(result.work.node_pairs + 20 * result.work.leaf_pairs, 30 * result.flags.size()) << clearance;
  }
}

/// Flags settle nodes by single points, first poses do not.
TEST(Trajectory, LargeClearancesFlagTheSamePoints)
{
  const Corridor corridor;
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  const Poses poses = alongCorridor(10, 12, 7);
  for (const double clearance : {0.7, 1.0, 1.5}) {
    TrajectoryRequest request = flagsOnly(clearance);
    const TrajectoryResult flags = collideAlong({scan}, model, poses, request);
    request.first_poses = true;
    EXPECT_GT(flags.colliding, 0u);
    EXPECT_LT(flags.colliding, flags.flags.size());
    EXPECT_EQ(flags.flags, collideAlong({scan}, model, poses, request).flags) << clearance;
  }
}

/// A room around a small dense model.
struct Room {
  std::vector<Eigen::Vector3f> walls, model;

  Room(std::size_t points, std::size_t model_points)
  {
    Random random(5);
    for (std::size_t i = 0; i < points; ++i) {
      Eigen::Vector3d p{random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-1, 1)};
      const auto side = static_cast<Eigen::Index>(i % 3);
      p[side] = std::copysign(3.0 - static_cast<double>(side), p[side]);
      walls.push_back(p.cast<float>());
    }
    for (std::size_t i = 0; i < model_points; ++i)
      model.push_back(
          Eigen::Vector3d{0.2 * random.uniform(-1, 1), 0.2 * random.uniform(-1, 1), 0.4 * random.uniform(-1, 1)}
              .cast<float>());
  }

  static PointsView view(const std::vector<Eigen::Vector3f>& points)
  {
    return viewOf(points.front().data(), points.size());
  }

  static Poses poses(std::size_t count)
  {
    Poses result;
    for (std::size_t k = 0; k < count; ++k) {
      result.emplace_back(Eigen::AngleAxisd(0.3 * static_cast<double>(k), Eigen::Vector3d(1, 2, 3).normalized()));
      result.back().translation() = Eigen::Vector3d(0.4 * static_cast<double>(k) - 1, 0.3, -0.2);
    }
    return result;
  }
};

TEST(Trajectory, DistancesAtLargeClearancesAreTheNearest)
{
  const Room room(700, 500);
  const SphereHierarchy scan(Room::view(room.walls)), model(Room::view(room.model));
  for (const std::size_t count : {1u, 2u, 5u}) {
    const Poses poses = Room::poses(count);
    for (const double clearance : {0.5, 1.5, 2.5, 40.0}) {
      SCOPED_TRACE(clearance);
      const TrajectoryResult expected = brute_force::collideAlong({scan}, model, poses, everything(clearance));
      EXPECT_GT(expected.colliding, 0u);
      expectSame(collideAlong({scan}, model, poses, everything(clearance)), expected);
      TrajectoryRequest request = flagsOnly(clearance);
      EXPECT_EQ(collideAlong({scan}, model, poses, request).flags, expected.flags);
      request.first_poses = true;
      EXPECT_EQ(collideAlong({scan}, model, poses, request).first_pose, expected.first_pose);
      request.closest_poses = true;
      const TrajectoryResult closest = collideAlong({scan}, model, poses, request);
      EXPECT_EQ(closest.first_pose, expected.first_pose);
      EXPECT_EQ(closest.closest_pose, expected.closest_pose);
      EXPECT_EQ(closest.closest_point, expected.closest_point);
    }
  }
}

/// A nearest neighbour for each point, not all pairs within the clearance.
TEST(Trajectory, DistancesAtLargeClearancesCostNoMoreThanTheNearest)
{
  const Room room(20000, 40000);
  const SphereHierarchy scan(Room::view(room.walls)), model(Room::view(room.model));
  for (const std::size_t count : {1u, 5u}) {
    const Poses poses = Room::poses(count);
    for (const double clearance : {0.5, 1.0, 3.0, 10.0}) {
      const TrajectoryResult found = collideAlong({scan}, model, poses, everything(clearance));
      const std::uint64_t work = found.work.node_pairs + 20 * found.work.leaf_pairs;
      EXPECT_LT(work, 400 * count * scan.view().count) << clearance << ", poses " << count;
    }
  }
}

TEST(Trajectory, MorePosesHitNoLess)
{
  const Corridor corridor;
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  const Poses poses = alongCorridor(2, 58, 65);
  std::vector<Verdict> denser;
  for (const std::size_t step : {1u, 2u, 4u, 64u}) {
    Poses some;
    for (std::size_t k = 0; k < poses.size(); k += step) some.push_back(poses[k]);
    const std::vector<Verdict> flags = collideAlong({scan}, model, some, flagsOnly(0.1)).flags;
    for (std::size_t p = 0; p < denser.size(); ++p) EXPECT_LE(flags[p], denser[p]);
    denser = flags;
  }
}

TEST(Trajectory, SamePosesInARowAreLookedAtOnce)
{
  const Corridor corridor;
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  const Poses once = alongCorridor(2, 20, 20);
  Poses thrice;
  for (const Eigen::Isometry3d& pose : once) thrice.insert(thrice.end(), 3, pose);
  collideAlong({scan}, model, once, everything(0.1)); // builds
  const TrajectoryResult expected = collideAlong({scan}, model, once, everything(0.1));
  const TrajectoryResult result = collideAlong({scan}, model, thrice, everything(0.1));
  EXPECT_EQ(result.work.leaf_pairs, expected.work.leaf_pairs);
  EXPECT_EQ(result.work.exact_decisions, expected.work.exact_decisions);
  for (std::size_t p = 0; p < expected.flags.size(); ++p) {
    EXPECT_EQ(result.first_pose[p], expected.first_pose[p] < 0 ? -1 : 3 * expected.first_pose[p]);
    EXPECT_EQ(result.closest_pose[p], expected.closest_pose[p] < 0 ? -1 : 3 * expected.closest_pose[p]);
  }
  for (std::size_t k = 0; k < thrice.size(); ++k)
    EXPECT_EQ(result.poses[k].colliding_points, expected.poses[k / 3].colliding_points);
}

TEST(Trajectory, ManyPointsInOnePlaceAnswerAlike)
{
  std::vector<Point3> points(5000, Point3{1, 0, 0});
  for (int i = 0; i < 100; ++i) points.push_back({2 + 0.01 * i, 0, 0});
  const Cloud cloud(points), probe(std::vector<Point3>{{0, 0, 0}});
  Poses poses(4, identity);
  for (std::size_t k = 0; k < 4; ++k) poses[k].translation().x() = static_cast<double>(k);
  const SphereHierarchy scan(cloud.view()), model(probe.view());
  const TrajectoryResult result = collideAlong({scan}, model, poses, everything(0.25));
  expectSame(result, brute_force::collideAlong({scan}, model, poses, everything(0.25)));
  EXPECT_EQ(result.poses[1].colliding_points, 5000u);
}

TEST(Trajectory, GeoreferencedAndTied)
{
  // Millimetres at half a million metres, clearances that some pairs meet exactly.
  std::vector<Point3> scan_points, model_points;
  for (int i = 0; i < 300; ++i) scan_points.push_back({500000.0 + 0.125 * i, 5400000.0, 100.0});
  for (int i = 0; i < 5; ++i) model_points.push_back({0.0, 0.125 * i, 0.0});
  const Cloud scan_cloud(scan_points, {Scalar::float64, 0, 0}), model_cloud(model_points, {Scalar::float64, 0, 0});
  Poses poses;
  for (int k = 0; k < 60; ++k) {
    poses.push_back(identity);
    poses.back().translation() = Eigen::Vector3d(500000.0 + 0.5 * k, 5400000.0, 100.0 + 0.0625 * (k % 7));
  }
  const SphereHierarchy scan(scan_cloud.view()), model(model_cloud.view());
  for (const double clearance : {0.0, 0.125, std::nextafter(0.125, 0.0), 0.25}) {
    SCOPED_TRACE(clearance);
    expectSame(collideAlong({scan}, model, poses, everything(clearance)),
               brute_force::collideAlong({scan}, model, poses, everything(clearance)));
  }
}

/// A turn by little moves what is far from the pivot by much: also by what it strays from an even motion.
TEST(Trajectory, FarFromThePivotOfAJerkyTurn)
{
  Random random(21);
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const auto far_out = [&](std::size_t count) {
      std::vector<Point3> points(count);
      for (Point3& p : points) p = {1e4 + random.uniform(-1, 1), random.uniform(-20, 20), random.uniform(-1, 1)};
      return points;
    };
    std::vector<Point3> of_model = far_out(300);
    of_model.push_back({-1e4, 0, 0}); // its middle, about which it turns, is the origin
    const Cloud scan_cloud(far_out(40)), model_cloud(of_model);
    Poses poses(24, identity);
    for (Eigen::Isometry3d& pose : poses)
      pose.rotate(Eigen::AngleAxisd(random.uniform(-1e-3, 1e-3), Eigen::Vector3d::UnitZ()));
    const SphereHierarchy scan(scan_cloud.view()), model(model_cloud.view());
    const TrajectoryResult expected = brute_force::collideAlong({scan}, model, poses, everything(0.3));
    expectSame(collideAlong({scan}, model, poses, everything(0.3)), expected);
    EXPECT_EQ(collideAlong({scan}, model, poses, flagsOnly(0.3)).flags, expected.flags);
  }
}

/// Poses as far from rigid as they may be: the model sees a clearance longer or shorter than it is.
TEST(Trajectory, TiesUnderPosesThatStretch)
{
  constexpr double clearance = 1024.0;
  for (const double stretch : {1.0 - 2.8e-7, 1.0, 1.0 + 2.8e-7})
    for (const double away : {clearance, std::nextafter(clearance, 2.0 * clearance)}) {
      SCOPED_TRACE(std::to_string(stretch) + (away > clearance ? ", beyond" : ""));
      const Cloud scan_cloud({{away, 0, 0}}, {Scalar::float64, 0, 0}), model_cloud({{0, 0, 0}});
      Poses poses(3, identity);
      for (Eigen::Isometry3d& pose : poses) pose.linear() *= stretch;
      const SphereHierarchy scan(scan_cloud.view()), model(model_cloud.view());
      EXPECT_EQ(collideAlong({scan}, model, poses, flagsOnly(clearance)).colliding, away > clearance ? 0u : 1u);
    }
}

TEST(Trajectory, ExtremeMagnitudes) // H8, H9
{
  for (const double scale : {1e-300, 1e-40, 1e-20, 1e20, 1e30, 1e150, 1e300}) {
    SCOPED_TRACE(scale);
    std::vector<Point3> points;
    for (int i = 0; i < 40; ++i) points.push_back({scale * (i % 7), scale * (i % 5) * 0.5, scale * 0.1 * i});
    const Cloud cloud(points, {Scalar::float64, 0, 0});
    const SphereHierarchy scan(cloud.view()), model(cloud.view());
    Poses poses(6, identity);
    for (std::size_t k = 0; k < poses.size(); ++k) poses[k].translation().x() = scale * static_cast<double>(k);
    expectSame(collideAlong({scan}, model, poses, everything(0.7 * scale)),
               brute_force::collideAlong({scan}, model, poses, everything(0.7 * scale)));
  }
}

TEST(Trajectory, NothingCollidesWithNothing)
{
  const std::vector<Point3> bad(20, Point3{std::numeric_limits<double>::quiet_NaN(), 0, 0});
  const Cloud none(std::vector<Point3>{}), spoiled(bad), some(std::vector<Point3>{{0, 0, 0}});
  for (const Cloud* a : {&none, &spoiled, &some})
    for (const Cloud* b : {&none, &spoiled, &some})
      for (const std::size_t count : {0u, 1u, 3u}) {
        const SphereHierarchy scan(a->view()), model(b->view());
        const Poses poses(count, identity);
        const TrajectoryResult result = collideAlong({scan}, model, poses, everything(1.0));
        expectSame(result, brute_force::collideAlong({scan}, model, poses, everything(1.0)));
        EXPECT_EQ(result.colliding, a == &some && b == &some && count > 0 ? 1u : 0u);
        EXPECT_EQ(result.poses.size(), count);
        TrajectoryRequest swept = flagsOnly(1.0);
        swept.swept = 0.1;
        EXPECT_EQ(collideAlong({scan}, model, poses, swept).colliding, result.colliding);
      }
}

TEST(Trajectory, ReportsProgressAndStops)
{
  const Corridor corridor;
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  for (const unsigned threads : {1u, 2u}) {
    TrajectoryRequest request = flagsOnly(0.1);
    request.threads = threads;
    std::vector<double> fractions;
    const std::thread::id caller = std::this_thread::get_id();
    request.progress = [&](double fraction) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      fractions.push_back(fraction);
      return true;
    };
    const TrajectoryResult result = collideAlong({scan}, model, alongCorridor(2, 58, 100), request);
    EXPECT_GT(result.colliding, 0u);
    ASSERT_FALSE(fractions.empty());
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GT(fractions.front(), 0.0);
    EXPECT_LE(fractions.back(), 1.0);
    int calls = 0;
    request.progress = [&](double) {
      ++calls;
      return false;
    };
    EXPECT_THROW(collideAlong({scan}, model, alongCorridor(2, 58, 100), request), Cancelled);
    EXPECT_EQ(calls, 1);
  }
}

std::string refusal(const Poses& poses, const TrajectoryRequest& request)
{
  const Cloud cloud(std::vector<Point3>{{0, 0, 0}, {1, 0, 0}});
  const SphereHierarchy scan(cloud.view()), model(cloud.view());
  try {
    collideAlong({scan}, model, poses, request);
  }
  catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Trajectory, BruteForceAnswersWhatIsAskedAtPoses)
{
  const test::Cloud of_scan({{10, 0, 0}, {0, 0, 0}, {3, 4, 0}}), of_model({{0, 0, -5}, {3, 4, 0}});
  const SphereHierarchy scan(of_scan.view()), model(of_model.view());
  const Poses poses(2, identity);
  TrajectoryRequest request;
  request.clearance = 5;
  request.flags = request.first_poses = request.distances = request.closest_poses = request.pose_summaries = false;
  const TrajectoryResult nothing = brute_force::collideAlong({scan}, model, poses, request);
  EXPECT_TRUE(nothing.flags.empty() && nothing.poses.empty() && nothing.first_pose.empty());
  EXPECT_EQ(nothing.colliding, 0u);
  EXPECT_EQ(nothing.work.exact_decisions, 0u);
  request.first_poses = true;
  const TrajectoryResult first = brute_force::collideAlong({scan}, model, poses, request);
  EXPECT_TRUE(first.flags.empty());
  EXPECT_EQ(first.first_pose, (std::vector<std::int32_t>{-1, 0, 0}));
  request.swept = 0.1;
  EXPECT_THROW(brute_force::collideAlong({scan}, model, poses, request), std::invalid_argument);
}

TEST(Trajectory, RefusesWhatMakesNoSense)
{
  using testing::HasSubstr;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Poses poses(3, identity);
  EXPECT_THAT(refusal(poses, flagsOnly(-1)), HasSubstr("clearance: -1"));
  EXPECT_THAT(refusal(poses, flagsOnly(nan)), HasSubstr("clearance: nan"));
  TrajectoryRequest swept = flagsOnly(0);
  for (const double tolerance : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    swept.swept = tolerance;
    EXPECT_THAT(refusal(poses, swept), HasSubstr("swept"));
  }
  swept.swept = 1e-30;
  EXPECT_THAT(refusal(poses, swept), HasSubstr("too small for coordinates"));
  swept.swept = 0.1;
  swept.pivot = {0, nan, 0};
  EXPECT_THAT(refusal(poses, swept), HasSubstr("pivot: nan"));
  swept.pivot = {0, 0, 0};
  swept.pose_summaries = true;
  EXPECT_THAT(refusal(poses, swept), HasSubstr("pose_summaries"));
  poses[1].linear() *= 1.1;
  EXPECT_THAT(refusal(poses, flagsOnly(0)), HasSubstr("pose 1 of the model: not rigid"));
  poses[1] = identity;
  poses[2].translation().x() = nan;
  EXPECT_THAT(refusal(poses, flagsOnly(0)), HasSubstr("pose 2 of the model: not finite"));
  swept.pose_summaries = false;
  poses[2] = identity;
  poses[2].linear() = Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  poses[2].translation().x() = 1e6;
  swept.swept = 1e-8;
  EXPECT_THAT(refusal(poses, swept), HasSubstr("too small for coordinates"));
  poses.insert(poses.end(), {poses[1], poses[2], poses[1], poses[2]});
  swept.swept = 1e-6;
  EXPECT_THAT(refusal(poses, swept), HasSubstr("from pose 1 to the next"));
}

// --- accuracy ---

/// A journey, its hierarchies, and what is true of it.
struct TrueJourney {
  TrueJourney(std::uint64_t seed, int max_points, int max_poses)
  : run(anyJourney(seed, max_points, max_poses)),
    scan(run.scene.a.view()),
    model(run.scene.b.view()),
    truth(within(0.0))
  {
  }

  /// By brute force, with so much more clearance.
  TrajectoryResult within(double more) const
  {
    return brute_force::collideAlong({scan, run.scene.pose_a}, model, run.poses,
                                     everything(std::max(0.0, run.scene.clearance + more)));
  }

  TrajectoryResult at(const Accuracy& accuracy, TrajectoryRequest request, unsigned threads = 1) const
  {
    request.accuracy = accuracy;
    request.threads = threads;
    return collideAlong({scan, run.scene.pose_a}, model, run.poses, request);
  }

  TrajectoryResult flagsAt(const Accuracy& accuracy, unsigned threads = 1) const
  {
    return at(accuracy, flagsOnly(run.scene.clearance), threads);
  }

  Journey run;
  SphereHierarchy scan, model;
  TrajectoryResult truth;
};

/// None wrong, and counted; `before` holds what coarser settings decided, and takes what this one does.
std::size_t expectNoneWrong(const TrueJourney& journey, const Accuracy& accuracy, std::vector<Verdict>* before)
{
  SCOPED_TRACE(journey.run.name + " at " + accuracy.text());
  const TrajectoryResult result = journey.flagsAt(accuracy);
  const std::vector<Verdict>& flags = result.flags;
  EXPECT_EQ(flags.size(), journey.truth.flags.size());
  for (std::size_t i = 0; i < flags.size(); ++i) {
    EXPECT_TRUE(flags[i] == Verdict::undecided || flags[i] == journey.truth.flags[i]) << "point " << i;
    if (before && (*before)[i] != Verdict::undecided) {
      EXPECT_EQ(flags[i], (*before)[i]) << "point " << i << " was decided";
    }
  }
  EXPECT_EQ(result.colliding, static_cast<std::size_t>(std::count(flags.begin(), flags.end(), Verdict::colliding)));
  EXPECT_EQ(result.undecided, static_cast<std::size_t>(std::count(flags.begin(), flags.end(), Verdict::undecided)));
  if (before) *before = flags;
  return result.undecided;
}

void expectNarrowing(const TrueJourney& journey, const std::vector<Accuracy>& settings, std::size_t& undecided)
{
  std::vector<Verdict> flags(journey.truth.flags.size(), Verdict::undecided);
  for (const Accuracy& accuracy : settings) undecided += expectNoneWrong(journey, accuracy, &flags);
  EXPECT_EQ(flags, journey.truth.flags) << journey.run.name;
}

TEST(TrajectoryAccuracy, LevelsAreNeverWrongAndNarrow)
{
  std::vector<Accuracy> levels;
  for (const unsigned level : {0u, 1u, 2u, 3u, 4u, 5u, 100u}) levels.push_back(Accuracy::level(level));
  std::size_t undecided = 0;
  for (std::uint64_t seed = 3000; seed < 3080 && !::testing::Test::HasFailure(); ++seed)
    expectNarrowing(TrueJourney(seed, seed % 4 == 0 ? 600 : 60, 20), levels, undecided);
  EXPECT_GT(undecided, 2000u) << "hardly anything was ever undecided";
}

TEST(TrajectoryAccuracy, BudgetsAreNeverWrongAndNarrow)
{
  std::vector<Accuracy> budgets = {Accuracy::nodePairs(0)};
  for (std::uint64_t count = 1; count <= (1u << 20); count *= 4) budgets.push_back(Accuracy::nodePairs(count));
  budgets.push_back(Accuracy::nodePairs(std::uint64_t{1} << 50));
  std::size_t undecided = 0;
  for (std::uint64_t seed = 3100; seed < 3180 && !::testing::Test::HasFailure(); ++seed)
    expectNarrowing(TrueJourney(seed, seed % 4 == 0 ? 600 : 60, 20), budgets, undecided);
  EXPECT_GT(undecided, 5000u) << "hardly anything was ever undecided";
}

TEST(TrajectoryAccuracy, TimesAreNeverWrong)
{
  for (std::uint64_t seed = 3200; seed < 3230; ++seed) {
    const TrueJourney journey(seed, 200, 20);
    for (const double seconds : {0.0, 1e-6, 1e-5, 1e-4}) expectNoneWrong(journey, Accuracy::time(seconds), nullptr);
    EXPECT_EQ(expectNoneWrong(journey, Accuracy::time(60), nullptr), 0u);
  }
}

TEST(TrajectoryAccuracy, ToleranceErrsOnlyWithinIt)
{
  std::size_t earlier = 0;
  for (std::uint64_t seed = 3300; seed < 3400 && !::testing::Test::HasFailure(); ++seed) {
    const TrueJourney journey(seed, 60, 20);
    const TrajectoryResult& truth = journey.truth;
    for (const double part : {0.0, 1e-9, 0.01, 0.3, 2.0}) {
      const double length = part * (journey.run.scene.clearance + 1e-3);
      SCOPED_TRACE(journey.run.name + " within " + std::to_string(length));
      const TrajectoryResult most = journey.within(length);
      const TrajectoryResult flags = journey.flagsAt(Accuracy::tolerance(length));
      const TrajectoryResult all = journey.at(Accuracy::tolerance(length), everything(journey.run.scene.clearance));
      EXPECT_EQ(all.undecided, 0u);
      for (std::size_t i = 0; i < truth.flags.size(); ++i) {
        for (const TrajectoryResult* result : {&flags, &all}) {
          ASSERT_LE(truth.flags[i], result->flags[i]) << i;
          ASSERT_LE(result->flags[i], most.flags[i]) << i;
        }
        earlier += flags.flags[i] != truth.flags[i];
        if (all.flags[i] == Verdict::free) continue;
        ASSERT_GE(all.first_pose[i], most.first_pose[i]);
        if (truth.flags[i] != Verdict::free) {
          ASSERT_LE(all.first_pose[i], truth.first_pose[i]);
          ASSERT_EQ(all.distance[i], truth.distance[i]) << i;
          ASSERT_EQ(all.closest_pose[i], truth.closest_pose[i]) << i;
        }
        else {
          ASSERT_GE(all.distance[i], most.distance[i]);
          ASSERT_LE(static_cast<double>(all.distance[i]),
                    (journey.run.scene.clearance + length) * (1 + 1e-6)); // floats
        }
      }
      for (std::size_t k = 0; k < truth.poses.size(); ++k) {
        ASSERT_LE(truth.poses[k].colliding_points, all.poses[k].colliding_points);
        ASSERT_LE(all.poses[k].colliding_points, most.poses[k].colliding_points);
        if (truth.poses[k].colliding) {
          ASSERT_EQ(all.poses[k].distance, truth.poses[k].distance);
        }
      }
    }
  }
  EXPECT_GT(earlier, 0u) << "no tolerance ever made a difference: nothing was tested";
}

TEST(TrajectoryAccuracy, SameForAnyNumberOfThreads)
{
  for (std::uint64_t seed = 3500; seed < 3510; ++seed) {
    const TrueJourney journey(seed, 600, 20);
    for (const char* setting : {"level=1", "level=2", "pairs=2000", "tolerance=0.1"}) {
      const Accuracy accuracy = Accuracy::parse(setting);
      EXPECT_EQ(journey.flagsAt(accuracy, 4).flags, journey.flagsAt(accuracy).flags) << setting;
    }
  }
}

// Noise-free: what a setting saves.
TEST(TrajectoryAccuracy, LessAccuracyIsLessWork)
{
  const Corridor corridor;
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  const Poses poses = alongCorridor(2, 58, 200);
  const SphereHierarchy untouched(corridor.walls.view(), options), unbuilt(corridor.cart.view());
  TrajectoryRequest request = flagsOnly(0.1);
  request.accuracy = Accuracy::level(0);
  const TrajectoryResult coarsest = collideAlong({untouched}, unbuilt, poses, request);
  EXPECT_EQ(coarsest.work.voxels_built, 0u);
  EXPECT_EQ(untouched.statistics().voxels_built + unbuilt.statistics().voxels_built, 0u);
  EXPECT_GT(coarsest.undecided, 0u);
  EXPECT_LT(coarsest.undecided, coarsest.flags.size()) << "some voxels are out of reach";

  const SphereHierarchy scan(corridor.walls.view(), options), model(corridor.cart.view());
  const auto resultAt = [&](const Accuracy& accuracy) {
    request.accuracy = accuracy;
    return collideAlong({scan}, model, poses, request);
  };
  const auto cost = [](const TrajectoryResult& result) { return result.work.node_pairs + 20 * result.work.leaf_pairs; };
  const TrajectoryResult exact = resultAt(Accuracy::exact());
  EXPECT_LT(10 * cost(resultAt(Accuracy::tolerance(0.01))), 11 * cost(exact)); // other nodes are settled whole
  EXPECT_LT(cost(resultAt(Accuracy::tolerance(0.2))), cost(exact));
  EXPECT_LT(cost(resultAt(Accuracy::level(1))), cost(exact));
  EXPECT_LE(cost(resultAt(Accuracy::level(1))), cost(resultAt(Accuracy::level(2))));
  for (const std::uint64_t budget : {0u, 1000u, 10000u}) {
    const TrajectoryResult spent = resultAt(Accuracy::nodePairs(budget));
    // Beyond the budget: what a walk begins with in each voxel, and the tests above the voxels (142 here).
    EXPECT_LE(spent.work.node_pairs, budget + 1150);
    EXPECT_LE(spent.work.leaf_pairs, budget);
  }
  EXPECT_EQ(resultAt(Accuracy::exact()).flags, exact.flags);
}

TEST(TrajectoryAccuracy, ReportsProgressThroughItsPasses)
{
  const Corridor corridor;
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  TrajectoryRequest request = flagsOnly(0.1);
  request.accuracy = Accuracy::nodePairs(1u << 30);
  std::vector<double> fractions;
  request.progress = [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  };
  collideAlong({scan}, model, alongCorridor(2, 58, 100), request);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GT(fractions.back(), 0.66);
  EXPECT_LE(fractions.back(), 1.0);
  request.progress = [](double) { return false; };
  EXPECT_THROW(collideAlong({scan}, model, alongCorridor(2, 58, 100), request), Cancelled);
}

TEST(TrajectoryAccuracy, RefusesWhatItCannotTell)
{
  using testing::AllOf;
  using testing::HasSubstr;
  const Poses poses(2, identity);
  TrajectoryRequest request = flagsOnly(0.1);
  for (const char* setting : {"level=2", "pairs=10", "time=1"}) {
    request.accuracy = Accuracy::parse(setting);
    EXPECT_EQ(refusal(poses, request), "nothing");
    for (bool TrajectoryRequest::*more : {&TrajectoryRequest::distances, &TrajectoryRequest::first_poses,
                                          &TrajectoryRequest::closest_poses, &TrajectoryRequest::pose_summaries}) {
      TrajectoryRequest asking = request;
      asking.*more = true;
      EXPECT_THAT(refusal(poses, asking),
                  AllOf(HasSubstr("accuracy: " + std::string(setting)), HasSubstr("give exact or tolerance=LENGTH")));
    }
  }
  for (const char* setting : {"tolerance=0.1", "level=2"}) {
    request = flagsOnly(0.1);
    request.swept = 0.1;
    request.accuracy = Accuracy::parse(setting);
    EXPECT_THAT(refusal(poses, request), HasSubstr("swept motion has a tolerance of its own: give exact"));
  }
  request = flagsOnly(0.1);
  request.accuracy = Accuracy::tolerance(-1);
  EXPECT_THAT(refusal(poses, request), HasSubstr("accuracy: tolerance=-1: give a finite number >= 0"));
}

TEST(TrajectorySwept, CatchesAThinPoleBetweenPoses)
{
  std::vector<Point3> pole;
  for (int i = 0; i <= 100; ++i) pole.push_back({10.5, 0.1, 0.02 * i});
  const Cloud scan_cloud(pole), model_cloud(shell({-0.1, -0.3, 0.5}, {0.1, 0.3, 1.5}, 0.05));
  const SphereHierarchy scan(scan_cloud.view()), model(model_cloud.view());
  Poses poses(21, identity);
  for (std::size_t k = 0; k < poses.size(); ++k) poses[k].translation().x() = static_cast<double>(k);
  TrajectoryRequest request = flagsOnly(0.05);
  EXPECT_EQ(collideAlong({scan}, model, poses, request).colliding, 0u);
  request.swept = 0.001;
  const TrajectoryResult result = collideAlong({scan}, model, poses, request);
  EXPECT_EQ(result.colliding, 55u); // from 0.5 - 0.05 to 1.5 + 0.05, every 0.02
  ASSERT_TRUE(result.first_contact);
  EXPECT_EQ(result.first_contact->pose, 10u);
  EXPECT_NEAR(result.first_contact->fraction, 0.35, 0.001); // 0.1 ahead of the origin, 0.05 of clearance
}

TEST(TrajectorySwept, CatchesAPoleThatATurnSweeps)
{
  // A boom of ten metres turns by a quarter in one go; the pole stands where neither pose sees it.
  std::vector<Point3> boom;
  for (int i = 0; i <= 1000; ++i) boom.push_back({0.01 * i, 0, 1});
  const double angle = 0.7, radius = 9.0;
  const Cloud scan_cloud(std::vector<Point3>{{radius * std::cos(angle), radius * std::sin(angle), 1}}),
      model_cloud(boom);
  const SphereHierarchy scan(scan_cloud.view()), model(model_cloud.view());
  Poses poses(2, identity);
  poses[1].linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  TrajectoryRequest request = flagsOnly(0.05);
  EXPECT_EQ(collideAlong({scan}, model, poses, request).colliding, 0u);
  request.swept = 0.001;
  request.distances = true;
  const TrajectoryResult result = collideAlong({scan}, model, poses, request);
  EXPECT_EQ(result.colliding, 1u);
  EXPECT_NEAR(result.distance[0], 0.0, 0.0006);
  ASSERT_TRUE(result.first_contact);
  EXPECT_NEAR(result.first_contact->fraction, (angle - 0.05 / radius) / (M_PI / 2), 0.001 / radius);
}

TEST(TrajectorySwept, ShrinksToTheTruthWithTheTolerance)
{
  const Corridor corridor;
  const Poses poses = alongCorridor(2, 58, 30);
  const SphereHierarchy scan(corridor.walls.view()), model(corridor.cart.view());
  std::vector<Verdict> wider = std::vector<Verdict>(corridor.walls.view().count, Verdict::colliding);
  const std::vector<Verdict> at_poses = collideAlong({scan}, model, poses, flagsOnly(0.1)).flags;
  for (const double tolerance : {0.16, 0.01, 0.000625}) { // each a sixteenth of the one before
    TrajectoryRequest request = flagsOnly(0.1);
    request.swept = tolerance;
    const std::vector<Verdict> flags = collideAlong({scan}, model, poses, request).flags;
    for (std::size_t p = 0; p < flags.size(); ++p) {
      EXPECT_LE(at_poses[p], flags[p]);
      EXPECT_LE(flags[p], wider[p]);
    }
    wider = flags;
  }
}

TEST(TrajectorySwept, PosesBetween)
{
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d from = random.pose(10), to = random.pose(10);
    const Point3 pivot = random.point([&] { return random.uniform(-5, 5); });
    const Eigen::Vector3d p(pivot[0], pivot[1], pivot[2]);
    EXPECT_LT((poseBetween(from, to, 0, pivot).matrix() - from.matrix()).norm(), 1e-12);
    EXPECT_LT((poseBetween(from, to, 1, pivot).matrix() - to.matrix()).norm(), 1e-12);
    const double f = random.uniform(0, 1);
    const Eigen::Isometry3d between = poseBetween(from, to, f, pivot);
    EXPECT_LT((between * p - ((1 - f) * (from * p) + f * (to * p))).norm(), 1e-12);
    const auto angle = [](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
      return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
    };
    EXPECT_NEAR(angle(from, between), f * angle(from, to), 1e-7);
  }
}

} // namespace
} // namespace pcl_bsh
