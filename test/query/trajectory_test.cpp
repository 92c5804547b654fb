// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/trajectory.h>

#include "random_clouds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_bsh {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;
using test::Cloud;
using test::Random;
using test::Scene;
using test::Shape;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

TrajectoryRequest everything(double clearance, unsigned threads = 1)
{
  TrajectoryRequest request;
  request.clearance = clearance;
  request.distances = request.first_poses = request.closest_poses = request.pose_summaries = true;
  request.threads = threads;
  return request;
}

TrajectoryRequest flagsOnly(double clearance)
{
  TrajectoryRequest request;
  request.clearance = clearance;
  return request;
}

/// NaN equals NaN here.
std::vector<std::uint32_t> bitsOf(const std::vector<float>& values)
{
  std::vector<std::uint32_t> bits(values.size());
  std::memcpy(bits.data(), values.data(), values.size() * sizeof(float));
  return bits;
}

void expectSame(const TrajectoryResult& result, const TrajectoryResult& expected)
{
  EXPECT_EQ(result.flags, expected.flags);
  EXPECT_EQ(result.colliding, expected.colliding);
  EXPECT_EQ(bitsOf(result.distance), bitsOf(expected.distance));
  EXPECT_EQ(result.first_pose, expected.first_pose);
  EXPECT_EQ(result.closest_pose, expected.closest_pose);
  EXPECT_EQ(result.closest_point, expected.closest_point);
  ASSERT_EQ(result.poses.size(), expected.poses.size());
  for (std::size_t k = 0; k < result.poses.size(); ++k) {
    SCOPED_TRACE("pose " + std::to_string(k));
    EXPECT_EQ(result.poses[k].colliding, expected.poses[k].colliding);
    EXPECT_EQ(result.poses[k].colliding_points, expected.poses[k].colliding_points);
    EXPECT_EQ(result.poses[k].distance, expected.poses[k].distance);
  }
}

/// A model's way: each kind that has a trap of its own. It starts at `start`, where the scene has its model.
Poses anyPath(const Eigen::Isometry3d& start, const Point3& center, double scale, std::size_t count, Random& random)
{
  const Eigen::Vector3d middle(center[0], center[1], center[2]);
  const auto direction = [&] {
    return Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
  };
  const int kind = random.integer(0, 6);
  const Eigen::Vector3d along = direction(), axis = direction();
  const double step = scale * random.uniform(0.01, 0.5), turn = random.uniform(-0.5, 0.5);
  Eigen::Isometry3d at = start;
  Poses poses;
  for (std::size_t k = 0; k < count; ++k) {
    poses.push_back(at);
    const auto about = [&](const Eigen::Vector3d& pivot, double angle) {
      return Eigen::Isometry3d(Eigen::Translation3d(pivot) * Eigen::AngleAxisd(angle, axis) *
                               Eigen::Translation3d(-pivot));
    };
    switch (kind) {
    case 0: // straight
      at = Eigen::Translation3d(step * along) * at;
      break;
    case 1: // on the spot
      at = at * about(middle, turn);
      break;
    case 2: // a bend
      at = Eigen::Translation3d(step * along) * at * about(middle, 0.1 * turn);
      break;
    case 3: // a loop about a far centre, which comes back to where it was
      at = start * about(middle + 20 * scale * along, 2 * M_PI / 16 * static_cast<double>(k + 1));
      break;
    case 4: // standing still, now and then a step
      if (random.chance(0.2)) at = Eigen::Translation3d(step * along) * at;
      break;
    case 5: // any poses
      at = start * about(middle, random.uniform(-3, 3)) * Eigen::Translation3d(scale * random.uniform(0, 1) * along);
      break;
    default: // there and back
      at = start;
      at.translation() += scale / 8 * static_cast<double>(k % 8 < 4 ? k % 8 : 8 - k % 8) * along;
      break;
    }
  }
  return poses;
}

struct Journey {
  Scene scene;
  Poses poses;
  std::string name;
};

Journey anyJourney(std::uint64_t seed, int max_points, int max_poses)
{
  Random random(seed + 77);
  Scene scene = test::anyScene(seed, max_points);
  const PointsView view = scene.b.view();
  Point3 center = {0, 0, 0};
  double scale = 1.0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Point3 p = view.point(view.record(i));
    if (std::isfinite(p[0] + p[1] + p[2])) {
      center = p;
      const Point3 q = view.point(view.record(view.size() / 2));
      const double extent = std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]);
      if (extent > 0 && extent < 1e5) scale = extent;
      break;
    }
  }
  const auto count = static_cast<std::size_t>(random.integer(0, max_poses));
  Poses poses = anyPath(scene.pose_b, center, scale, count, random);
  const std::string name = scene.name + ", " + std::to_string(poses.size()) + " poses";
  return {std::move(scene), std::move(poses), name};
}

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
  const PointsView &a = scan.hierarchy.view(), &b = model.view();
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
    if (result.flags[p] == 0) {
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
      expectTrueToSamples(run, tolerance, pivot, 1000);
    }
    catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("tolerance of the swept motion")) << run.name;
    }
    if (::testing::Test::HasFailure()) return;
  }
}

} // namespace
} // namespace pcl_bsh
