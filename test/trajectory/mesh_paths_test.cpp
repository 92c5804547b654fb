// SPDX-License-Identifier: BSD-3-Clause
// Triangles along a path: as the model, as the scan, as both.
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/journeys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::anyMeshJourney;
using test::everything;
using test::expectSame;
using test::flagsOnly;
using test::identity;
using test::Journey;
using test::Mesh;
using test::Poses;
using test::Random;

TEST(TrianglesAlongPaths, AgreeWithBruteForce)
{
  for (std::uint64_t seed = 0; seed < 240; ++seed) {
    const Journey run = anyMeshJourney(seed, 25, 12);
    SCOPED_TRACE(run.name);
    const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
    const Placed placed{scan, run.scene.pose_a};
    const TrajectoryRequest all = everything(run.scene.clearance, 1 + seed % 2);
    const TrajectoryResult truth = brute_force::collideAlong(placed, model, run.poses, all);
    expectSame(collideAlong(placed, model, run.poses, all), truth);
    const TrajectoryResult flags = collideAlong(placed, model, run.poses, flagsOnly(run.scene.clearance));
    EXPECT_EQ(flags.flags, truth.flags);
    TrajectoryRequest first = flagsOnly(run.scene.clearance);
    first.first_poses = true;
    EXPECT_EQ(collideAlong(placed, model, run.poses, first).first_pose, truth.first_pose);
    TrajectoryRequest closest = flagsOnly(run.scene.clearance);
    closest.distances = closest.closest_poses = true;
    const TrajectoryResult nearest = collideAlong(placed, model, run.poses, closest);
    EXPECT_EQ(test::bitsOf(nearest.distance), test::bitsOf(truth.distance));
    EXPECT_EQ(nearest.closest_pose, truth.closest_pose);
    EXPECT_EQ(nearest.closest_point, truth.closest_point);
    if (HasFailure()) return;
  }
}

TEST(TrianglesAlongPaths, AgreeWithBruteForceWherePlacesAreUncertain)
{
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Journey run = anyMeshJourney(seed, 20, 8);
    SCOPED_TRACE(run.name);
    Random random(seed);
    if (!(run.scene.clearance < 1e6)) continue;
    test::makeUncertain(run.scene.a, run.scene.clearance, random);
    test::makeUncertain(run.scene.b, run.scene.clearance, random);
    const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
    const Placed placed{scan, run.scene.pose_a};
    const TrajectoryRequest all = everything(run.scene.clearance);
    expectSame(collideAlong(placed, model, run.poses, all), brute_force::collideAlong(placed, model, run.poses, all));
    if (HasFailure()) return;
  }
}

TEST(TrianglesAlongPaths, StoppedEarlyAreNeverWrong)
{
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Journey run = anyMeshJourney(seed, 40, 20);
    SCOPED_TRACE(run.name);
    const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
    const Placed placed{scan, run.scene.pose_a};
    TrajectoryRequest request = flagsOnly(run.scene.clearance);
    const TrajectoryResult truth = brute_force::collideAlong(placed, model, run.poses, request);
    request.accuracy = Accuracy::level(static_cast<unsigned>(seed % 4));
    const TrajectoryResult some = collideAlong(placed, model, run.poses, request);
    for (std::size_t i = 0; i < some.flags.size(); ++i) {
      if (some.flags[i] == Verdict::undecided) continue;
      EXPECT_EQ(some.flags[i], truth.flags[i]) << i;
    }
    if (HasFailure()) return;
  }
}

/// Each record of the scan at many instants of a motion: the smallest gap.
std::vector<double> sampledGaps(const Journey& run, const SphereHierarchy& scan, const SphereHierarchy& model,
                                int instants)
{
  std::vector<double> gaps(scan.view().count, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k + 1 < run.poses.size(); ++k)
    for (int i = 0; i <= instants; ++i) {
      const Eigen::Isometry3d pose = poseBetween(run.poses[k], run.poses[k + 1], static_cast<double>(i) / instants);
      const RecordDistance distance(scan.view(), run.scene.pose_a, model.view(), pose);
      for (std::size_t a = 0; a < scan.view().size(); ++a)
        for (std::size_t b = 0; b < model.view().size(); ++b) {
          const PointPair pair{scan.view().record(a), model.view().record(b)};
          if (!isFinite(scan.view().point(pair.a)) || !isFinite(model.view().point(pair.b))) continue;
          const RecordDistance::Enclosure found = distance.enclose(distance.pair(pair));
          const double radii = scan.view().ownRadius(pair.a) + model.view().ownRadius(pair.b);
          gaps[pair.a] = std::min(gaps[pair.a], found.high - radii);
        }
    }
  return gaps;
}

/// How far any corner of the model goes from one instant to the next at most.
double stepOf(const Journey& run, const SphereHierarchy& model, int instants)
{
  double step = 0.0;
  for (std::size_t k = 0; k + 1 < run.poses.size(); ++k)
    for (std::size_t b = 0; b < model.view().size(); ++b) {
      const std::uint32_t record = model.view().record(b);
      const Point3 p = model.view().point(record);
      if (!isFinite(p)) continue;
      const Eigen::Vector3d at(p[0], p[1], p[2]);
      const double turn = (run.poses[k + 1].linear() - run.poses[k].linear()).norm();
      const double way = (run.poses[k + 1] * at - run.poses[k] * at).norm() * 2.0 + turn * model.view().radius(record) +
                         turn * at.norm();
      step = std::max(step, 2.0 * way / instants);
    }
  return step;
}

TEST(TrianglesAlongPaths, SweptAgreesWithManyInstants)
{
  int hits = 0, free = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Journey run = anyMeshJourney(seed, 12, 3);
    SCOPED_TRACE(run.name);
    const SphereHierarchy scan(run.scene.a.view()), model(run.scene.b.view());
    const Placed placed{scan, run.scene.pose_a};
    constexpr int instants = 60;
    const double step = stepOf(run, model, instants);
    if (run.poses.size() < 2 || step == 0.0 || scan.empty() || model.empty()) continue;
    TrajectoryRequest request = flagsOnly(run.scene.clearance);
    request.swept = step;
    request.distances = request.first_poses = true;
    TrajectoryResult found;
    try {
      found = collideAlong(placed, model, run.poses, request);
    }
    catch (const std::invalid_argument&) {
      continue; // half a turn
    }
    const double clearance = run.scene.clearance, tolerance = *request.swept;
    const std::vector<double> gaps = sampledGaps(run, scan, model, instants);
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      if (gaps[i] <= clearance * (1.0 - 1e-12)) {
        EXPECT_EQ(found.flags[i], Verdict::colliding) << i << " at " << gaps[i];
      }
      if (gaps[i] > clearance + tolerance + step) {
        EXPECT_EQ(found.flags[i], Verdict::free) << i << " at " << gaps[i];
      }
      if (found.flags[i] != Verdict::colliding) continue;
      EXPECT_LE(static_cast<double>(found.distance[i]), gaps[i] + 0.5 * tolerance + 1e-6 * tolerance) << i;
      EXPECT_GE(static_cast<double>(found.distance[i]), gaps[i] - step - 0.5 * tolerance) << i;
      EXPECT_GE(found.first_pose[i], 0);
    }
    for (const Verdict flag : found.flags) ++(flag == Verdict::colliding ? hits : free);
    if (HasFailure()) return;
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(free, 20);
}

/// A square of two triangles, turned by `turn` about z, in the plane z = 0.
Mesh square(double half, double turn)
{
  Mesh mesh;
  const auto corner = [&](double x, double y) {
    return Point3{half * (x * std::cos(turn) - y * std::sin(turn)), half * (x * std::sin(turn) + y * std::cos(turn)),
                  0};
  };
  mesh.add(corner(-1, -1), corner(1, -1), corner(1, 1));
  mesh.add(corner(-1, -1), corner(1, 1), corner(-1, 1));
  return mesh;
}

TEST(TrianglesAlongPaths, SweptMotionThatGrazesEnds)
{
  // A plate passes over another one just at the clearance, within the tolerance of it, and beyond that.
  const Mesh mesh = square(1.0, 0.3);
  test::Cloud cloud(mesh.vertices, test::Layout{Scalar::float64, 0, 0});
  cloud.setTriangles(mesh.corners);
  const SphereHierarchy plate(cloud.view());
  constexpr double clearance = 0.125, tolerance = 1e-6;
  std::uint64_t most = 0;
  for (const double beyond : {-1e-9, 0.0, 0.2, 0.5, 0.9, 1.1, 2.0}) {
    const double height = clearance + beyond * tolerance;
    for (const double turn : {0.0, 1.0}) {
      Poses poses(2, Eigen::Isometry3d(Eigen::Translation3d(-5, 0, height)));
      poses[1] = Eigen::Translation3d(5, 0, height) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
      TrajectoryRequest request = flagsOnly(clearance);
      request.swept = tolerance;
      const TrajectoryResult found = collideAlong({plate}, plate, poses, request);
      SCOPED_TRACE(std::to_string(beyond) + ", turn " + std::to_string(turn));
      if (beyond <= 0.0) {
        EXPECT_EQ(found.colliding, 2u);
      }
      if (beyond > 1.0) {
        EXPECT_EQ(found.colliding, 0u);
      }
      most = std::max(most, found.work.node_pairs + found.work.exact_decisions);
    }
  }
  EXPECT_LT(most, 2000000u);
}

} // namespace
} // namespace pcl_bsh
