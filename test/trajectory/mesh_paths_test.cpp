// SPDX-License-Identifier: BSD-3-Clause
// Triangles along a path: as the model, as the scan, as both.
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "geometry/soups.h"
#include "support/journeys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
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

/// A box that passes points on straight ways, where hundreds of poses are as near as doubles can tell, or quite so.
struct BoxBesidePoints {
  explicit BoxBesidePoints(std::uint64_t seed, std::size_t points, std::size_t poses) : points_(anywhere(seed, points))
  {
    Random random(seed);
    const double heading = seed % 3 == 0 ? 0.0 : random.uniform(-3, 3), slope = seed % 3 == 2 ? 0.02 : 0.0;
    const double far = seed % 2 == 0 ? 0.0 : 5402650.25;
    world_ = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(slope, Eigen::Vector3d::UnitY());
    world_.pretranslate(Eigen::Vector3d(far, 0.25 * far, 0));
    for (std::size_t i = 0; i < poses; ++i) {
      const double along = 12.0 * static_cast<double>(i) / static_cast<double>(poses) - 6.0;
      Eigen::Isometry3d pose = world_ * Eigen::Translation3d(along, 0, 0);
      if (seed % 5 == 4) pose.linear()(0, 1) += 1e-16 * random.integer(-1, 1);
      path.push_back(pose);
    }
    Mesh mesh;
    for (const Triangle3& t : test::boxOf({-4, -1.5, 0}, {4, 1.5, 3})) mesh.add(t[0], t[1], t[2]);
    box.emplace(mesh.vertices, test::Layout{Scalar::float64, 0, 0});
    box->setTriangles(std::move(mesh.corners));
    for (Point3& p : points_) {
      const Eigen::Vector3d at = world_ * Eigen::Vector3d(p[0], p[1], p[2]);
      p = {at.x(), at.y(), at.z()};
    }
    scan.emplace(points_, test::Layout{Scalar::float64, 0, 0});
  }

  std::optional<test::Cloud> scan, box;
  Poses path;

private:
  /// Beside the faces and edges along the way.
  static std::vector<Point3> anywhere(std::uint64_t seed, std::size_t count)
  {
    Random random(seed + 1);
    std::vector<Point3> points;
    for (std::size_t i = 0; i < count; ++i) {
      const double out = random.uniform(0, 0.06), up = random.chance(0.4) ? 3.0 + 0.5 * out : random.uniform(0, 3);
      points.push_back({random.uniform(-6, 6), (random.chance(0.5) ? 1.0 : -1.0) * (1.5 + out), up});
    }
    return points;
  }

  std::vector<Point3> points_;
  Eigen::Isometry3d world_;
};

TEST(TrianglesAlongPaths, StraightWaysBesideABoxAgreeWithBruteForce)
{
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const BoxBesidePoints way(seed, 30, 25);
    SCOPED_TRACE(seed);
    const SphereHierarchy scan(way.scan->view()), model(way.box->view());
    TrajectoryRequest request = everything(0.05);
    expectSame(collideAlong({scan}, model, way.path, request),
               brute_force::collideAlong({scan}, model, way.path, request));
    request.pose_summaries = false;
    const TrajectoryResult found = collideAlong({scan}, model, way.path, request);
    EXPECT_GT(found.colliding, 5u);
    expectSame(found, brute_force::collideAlong({scan}, model, way.path, request));
    if (HasFailure()) return;
  }
}

/// Long numbers tell the poses apart, and what is quite the same by the axes; few pairs are left for longer ones.
TEST(TrianglesAlongPaths, StraightWaysBesideABoxTakeFewExactDecisions)
{
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const BoxBesidePoints way(seed, 300, 300);
    const SphereHierarchy scan(way.scan->view()), model(way.box->view());
    TrajectoryRequest request = flagsOnly(0.05);
    request.distances = request.closest_poses = true;
    const TrajectoryResult found = collideAlong({scan}, model, way.path, request);
    ASSERT_GT(found.colliding, 100u);
    EXPECT_LT(found.work.exact_decisions, 6 * found.colliding) << seed;
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

std::uint64_t countOf(const Work& work)
{
  return work.node_pairs + work.leaf_pairs + work.exact_decisions;
}

/// A square sheet of 2 n n triangles in a plane z = height, 2 half wide.
Mesh sheetAt(double height, double half, int n)
{
  Mesh mesh;
  const auto corner = [&](int i, int j) { return Point3{half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), height}; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.add(corner(i, j), corner(i, j + 1), corner(i + 1, j));
      mesh.add(corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1));
    }
  return mesh;
}

test::Cloud cloudOf(const Mesh& mesh)
{
  test::Cloud cloud(mesh.vertices, test::Layout{Scalar::float64, 0, 0});
  cloud.setTriangles(mesh.corners);
  return cloud;
}

TEST(TrianglesAlongPaths, DistancesOfSurfacesThatCrossTakeNoMoreWorkWhereTheToleranceIsSmall)
{
  // A crate is carried through a floor, straight and turning: most of the way its walls cross it.
  Mesh crate_mesh;
  for (const auto& t : test::boxOf({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})) crate_mesh.add(t[0], t[1], t[2]);
  const test::Cloud of_crate = cloudOf(crate_mesh), of_floor = cloudOf(sheetAt(0.0, 10.5, 40));
  const SphereHierarchy crate(of_crate.view()), floor(of_floor.view());
  for (const double turn : {0.0, 1.0}) {
    Poses poses(2, Eigen::Isometry3d(Eigen::Translation3d(-10, 0.013, 0.1)));
    poses[1] = Eigen::Translation3d(10, 0.5, 0.1) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
    std::uint64_t least = 0;
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      SCOPED_TRACE(std::to_string(tolerance) + ", turn " + std::to_string(turn));
      TrajectoryRequest request = flagsOnly(0.0);
      request.swept = tolerance;
      request.first_poses = true;
      const std::uint64_t flags = countOf(collideAlong({floor}, crate, poses, request).work);
      request.distances = request.closest_poses = true;
      const TrajectoryResult found = collideAlong({floor}, crate, poses, request);
      if (tolerance == 1e-2) least = countOf(found.work);
      EXPECT_LT(countOf(found.work), turn == 0.0 ? 2 * least : 2 * flags + least); // what turns is cut into parts
      std::size_t crossed = 0;
      for (std::size_t i = 0; i < found.flags.size(); ++i)
        crossed += found.flags[i] == Verdict::colliding && found.distance[i] < 1e-12f;
      EXPECT_GT(crossed, 100u);
    }
  }
}

TEST(TrianglesAlongPaths, PlatesHardlyBeyondTheClearanceTakeNoMoreWorkThanTheirPoses)
{
  std::uint64_t before = 0;
  for (const int n : {32, 64}) {
    const test::Cloud of_scan = cloudOf(sheetAt(0.0, 1.0, n)), of_model = cloudOf(sheetAt(0.25, 1.0, n));
    const SphereHierarchy scan(of_scan.view()), model(of_model.view());
    for (const double below : {1e-3, 1e-6, 1e-12})
      for (const double turn : {0.0, 0.2}) {
        SCOPED_TRACE(std::to_string(n) + ", below by " + std::to_string(below) + ", turn " + std::to_string(turn));
        Poses poses;
        for (int k = 0; k < 5; ++k)
          poses.push_back(Eigen::Translation3d(0.025 * k, 0.0075 * k, 0.0) *
                          Eigen::AngleAxisd(0.25 * turn * k, Eigen::Vector3d::UnitZ()));
        const double clearance = 0.25 * (1.0 - below);
        std::uint64_t single = 0;
        for (const Eigen::Isometry3d& pose : poses) {
          FlagsRequest request;
          request.clearance = clearance;
          const FlagsResult found = collisionFlags({scan}, {model, pose}, request);
          EXPECT_EQ(found.colliding_a, 0u);
          single += countOf(found.work);
        }
        const TrajectoryResult found = collideAlong({scan}, model, poses, flagsOnly(clearance));
        EXPECT_EQ(found.colliding, 0u);
        EXPECT_LT(countOf(found.work), 2 * single);
        if (n == 64) {
          EXPECT_LT(countOf(found.work), 8 * before); // of four times as many triangles
        }
        if (below == 1e-6 && turn == 0.0) before = countOf(found.work);
      }
  }
}

TEST(TrianglesAlongPaths, PlatesHardlyBeyondTheClearanceAgreeWithBruteForceWhereTheyAreUneven)
{
  Random random(5);
  for (int i = 0; i < 40; ++i) {
    Mesh scan_mesh = sheetAt(0.0, 1.0, 8), model_mesh = sheetAt(0.25, 1.0, 8);
    for (Mesh* mesh : {&scan_mesh, &model_mesh})
      for (Point3& p : mesh->vertices)
        if (random.chance(0.02)) p[2] += random.uniform(-0.02, 0.02);
    const test::Cloud of_scan = cloudOf(scan_mesh), of_model = cloudOf(model_mesh);
    const SphereHierarchy scan(of_scan.view()), model(of_model.view());
    const double turn = i % 2 == 0 ? 0.0 : random.uniform(0, 0.3);
    Poses poses;
    for (int k = 0; k < 4; ++k)
      poses.push_back(Eigen::Translation3d(0.1 * k, random.uniform(0, 0.1), 0.001 * k) *
                      Eigen::AngleAxisd(turn * k, Eigen::Vector3d::UnitZ()));
    SCOPED_TRACE(i);
    const TrajectoryRequest all = everything(0.25 * (1.0 - std::exp2(-random.uniform(6, 40))));
    expectSame(collideAlong({scan}, model, poses, all), brute_force::collideAlong({scan}, model, poses, all));
    if (HasFailure()) return;
  }
}

TEST(TrianglesAlongPaths, ALargeTriangleAmongSmallOnesTakesLittleMoreWorkWhereMotionIsSwept)
{
  Poses poses(2, Eigen::Isometry3d::Identity());
  poses[1].translation() = Eigen::Vector3d(1, 0.5, 0.2);
  TrajectoryRequest request = flagsOnly(0.01);
  request.swept = 0.01;
  request.distances = request.first_poses = true;
  for (const int count : {100, 400}) {
    Random random(7);
    const auto soup = [&] {
      Mesh mesh;
      for (int i = 0; i < count; ++i) {
        const Point3 at = random.point([&] { return 3 * random.uniform(-1, 1); });
        const auto beside = [&] {
          const Point3 by = random.point([&] { return 0.2 * random.uniform(-1, 1); });
          return Point3{at[0] + by[0], at[1] + by[1], at[2] + by[2]};
        };
        mesh.add(at, beside(), beside());
      }
      return mesh;
    };
    const Mesh small = soup();
    Mesh with_large = small;
    with_large.add({-20, -20, -15}, {1e6, -20, -15}, {-20, 1e6, -15}); // beside them, and near none of the scan's
    const test::Cloud of_scan = cloudOf(soup()), of_small = cloudOf(small), of_all = cloudOf(with_large);
    const SphereHierarchy scan(of_scan.view());
    const TrajectoryResult without = collideAlong({scan}, SphereHierarchy(of_small.view()), poses, request);
    const TrajectoryResult found = collideAlong({scan}, SphereHierarchy(of_all.view()), poses, request);
    SCOPED_TRACE(count);
    EXPECT_GT(found.colliding, 0u);
    EXPECT_LT(countOf(found.work), 3 * countOf(without.work));
    EXPECT_EQ(found.flags, without.flags); // none is within the tolerance of the clearance
    EXPECT_EQ(found.first_pose, without.first_pose);
    for (std::size_t i = 0; i < found.distance.size(); ++i)
      if (found.flags[i] == Verdict::colliding) {
        EXPECT_NEAR(found.distance[i], without.distance[i], *request.swept) << i;
      }
  }
}

} // namespace
} // namespace pcl_bsh
