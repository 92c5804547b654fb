// SPDX-License-Identifier: BSD-3-Clause
// A few points far outside of all others: paths leave them to themselves, unless something comes near them.
#include <pcl_bsh/trajectory/outliers.h>

#include "support/journeys.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
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

using Points = std::vector<Point3>;

constexpr double kSentinel = std::numeric_limits<float>::max();

/// 320 points of a unit cube, some replaced: enough for voxels that hold outliers alone.
Points cubeWith(const Points& outliers, std::uint64_t seed)
{
  Random random(seed);
  Points points(320);
  for (Point3& p : points) p = random.point([&] { return random.uniform(-1, 1); });
  for (std::size_t i = 0; i < outliers.size(); ++i) points[20 * i + 7] = outliers[i];
  return points;
}

Poses ahead(std::size_t count, double step)
{
  Poses poses(count, Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < count; ++k) {
    poses[k].translation().x() = step * static_cast<double>(k);
    poses[k].rotate(Eigen::AngleAxisd(0.1 * static_cast<double>(k), Eigen::Vector3d::UnitZ()));
  }
  return poses;
}

struct Case {
  const char* name;
  Points in_scan, in_model;
  double step;    ///< from one pose to the next
  bool set_aside; ///< whether the outliers are
};

const Case kCases[] = {
    {"none", {}, {}, 0.2, false},
    {"sentinels", {{kSentinel, kSentinel, kSentinel}}, {{kSentinel, -kSentinel, 0}}, 0.2, true},
    {"of the scan alone", {{1e20, 0, 0}, {-1e20, 1, 0}}, {}, 0.2, true},
    {"of the model alone", {}, {{0, 1e20, 0}}, 0.2, true},
    {"that meet each other", {{0, 0, 1e9}, {0, 1e9, 0}}, {{0, 0, 1e9}}, 0.2, true},
    {"where the path goes", {{1e5, 0, 0}}, {}, 1e5, false},
    {"whose path goes to the scan", {}, {{-1e5, 0, 0}}, 1e5, false},
    {"not far enough", {{500, 0, 0}}, {{0, 0, -500}}, 0.2, false},
};

TEST(Outliers, AnswerAsBruteForce)
{
  for (const Case& outliers : kCases)
    for (const bool balls : {false, true}) {
      SCOPED_TRACE(outliers.name);
      test::Cloud scan(cubeWith(outliers.in_scan, 1)), model(cubeWith(outliers.in_model, 2));
      if (balls) {
        scan.setRadii(std::vector<float>(320, 0.02f));
        model.setRadii(std::vector<float>(320, 0.01f));
      }
      const SphereHierarchy of_scan(scan.view()), of_model(model.view());
      const Poses poses = ahead(4, outliers.step);
      EXPECT_EQ(findOutliers(of_scan, of_model, poses, 0.1).has_value(), outliers.set_aside);
      const TrajectoryResult expected = brute_force::collideAlong(of_scan, of_model, poses, everything(0.1));
      EXPECT_GT(expected.colliding, 5u);
      expectSame(collideAlong(of_scan, of_model, poses, everything(0.1)), expected);
    }
}

TEST(Outliers, OfBallsThatReachTheOthers)
{
  test::Cloud scan(cubeWith({{1e6, 0, 0}}, 1)), model(cubeWith({}, 2));
  std::vector<float> radii(320, 0.0f);
  radii[7] = 1e6f;
  scan.setRadii(radii);
  const SphereHierarchy of_scan(scan.view()), of_model(model.view());
  const Poses poses = ahead(3, 0.2);
  EXPECT_FALSE(findOutliers(of_scan, of_model, poses, 0.1).has_value());
  expectSame(collideAlong(of_scan, of_model, poses, everything(0.1)),
             brute_force::collideAlong(of_scan, of_model, poses, everything(0.1)));
}

/// A point far outside a small scan is in the midst of a large model, which is all in one voxel.
TEST(Outliers, OfAScanThatTheModelReachesBeyond)
{
  Points large = cubeWith({{0.1, 0x1p-22, 0}}, 2);
  for (Point3& p : large)
    for (double& x : p) x = 1e6 * (x + 1.0);
  const test::Cloud scan(cubeWith({{1e5, 0, 0}}, 1)), model(large);
  HierarchyOptions one_voxel;
  one_voxel.voxel_edge = 1e8;
  const SphereHierarchy of_scan(scan.view()), of_model(model.view(), one_voxel);
  ASSERT_EQ(of_model.statistics().voxels, 1u);
  const Poses poses = {Eigen::Isometry3d(Eigen::Translation3d(-1e6, -1e6, -1e6))};
  EXPECT_FALSE(findOutliers(of_scan, of_model, poses, 0.5).has_value());
  EXPECT_EQ(collideAlong(of_scan, of_model, poses, flagsOnly(0.5)).flags[7], Verdict::colliding);
}

/// A clearance so large that ordinary points meet an outlier.
TEST(Outliers, OfAClearanceThatExceedsTheirDistance)
{
  const test::Cloud scan(cubeWith({{1e5, 0, 0}}, 1)), model(cubeWith({{0, 1e6, 0}}, 2));
  const SphereHierarchy of_scan(scan.view()), of_model(model.view());
  const Poses poses = ahead(3, 0.2);
  EXPECT_TRUE(findOutliers(of_scan, of_model, poses, 1e4).has_value());
  EXPECT_FALSE(findOutliers(of_scan, of_model, poses, 1.5e5).has_value());
  const TrajectoryResult found = collideAlong(of_scan, of_model, poses, everything(1.5e5));
  expectSame(found, brute_force::collideAlong(of_scan, of_model, poses, everything(1.5e5)));
  EXPECT_EQ(found.flags[7], Verdict::colliding);
}

/// As far apart as they are, lengths below 1e-162 have squares that vanish.
TEST(Outliers, OfTheSmallestNumbers)
{
  for (const double scale : {1e-150, 1e-165, 1e-200, 1e-300}) {
    SCOPED_TRACE(scale);
    std::vector<Point3> in_scan = cubeWith({{1e5, 0, 0}, {1e5, 0.5, 0}}, 1), in_model = cubeWith({}, 2);
    for (auto* points : {&in_scan, &in_model})
      for (Point3& p : *points)
        for (double& x : p) x *= scale;
    const test::Cloud scan(in_scan, {Scalar::float64, 0, 0}), model(in_model, {Scalar::float64, 0, 0});
    const SphereHierarchy of_scan(scan.view()), of_model(model.view());
    Poses poses = ahead(2, 1e5 * scale); // the model comes to the outlier
    poses[1].linear().setIdentity();
    EXPECT_TRUE(findOutliers(of_scan, of_model, {poses[0]}, scale).has_value());
    EXPECT_FALSE(findOutliers(of_scan, of_model, poses, scale).has_value());
    const TrajectoryResult found = collideAlong(of_scan, of_model, poses, flagsOnly(scale));
    expectSame(found, brute_force::collideAlong(of_scan, of_model, poses, flagsOnly(scale)));
    EXPECT_EQ(found.flags[7], Verdict::colliding);
  }
}

/// Outliers that may meet each other, but need not: they are counted as they are flagged.
TEST(Outliers, AreCountedWhereUndecided)
{
  test::Cloud scan(cubeWith({{1e9, 0, 0}, {0, 1e9, 0}}, 1)), model(cubeWith({{1e9, 0, 0}, {0, 1e9, 0}}, 2));
  PointsView uncertain = scan.view();
  std::vector<float> own(uncertain.count, 0.0f);
  own[7] = 1e3f; // beside an outlier of the model; the next one is there for certain
  uncertain.uncertainties = own.data();
  const SphereHierarchy of_scan(uncertain), of_model(model.view());
  const Poses poses = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
  ASSERT_TRUE(findOutliers(of_scan, of_model, poses, 0.1).has_value());
  for (const bool sums : {false, true}) {
    TrajectoryRequest request = flagsOnly(0.1);
    request.pose_summaries = sums;
    const TrajectoryResult found = collideAlong(of_scan, of_model, poses, request);
    expectSame(found, brute_force::collideAlong(of_scan, of_model, poses, request));
    EXPECT_EQ(found.flags[7], Verdict::undecided);
    EXPECT_EQ(found.flags[27], Verdict::colliding);
    const auto count = [&](Verdict verdict) {
      return static_cast<std::size_t>(std::count(found.flags.begin(), found.flags.end(), verdict));
    };
    EXPECT_EQ(found.undecided, count(Verdict::undecided));
    EXPECT_EQ(found.colliding, count(Verdict::colliding));
    if (sums) {
      EXPECT_EQ(found.poses[0].undecided_points, found.undecided);
    }
  }
}

TEST(Outliers, OfPointsWhosePlacesAreUncertain)
{
  test::Cloud scan(cubeWith({{1e9, 0, 0}, {0, 1e9, 0}}, 1)), model(cubeWith({{0, 1e9, 0}}, 2));
  PointsView uncertain = scan.view();
  uncertain.uncertainty = 0.03;
  const SphereHierarchy of_scan(uncertain), of_model(model.view());
  const Poses poses = ahead(3, 0.2);
  EXPECT_TRUE(findOutliers(of_scan, of_model, poses, 0.1).has_value());
  expectSame(collideAlong(of_scan, of_model, poses, everything(0.1)),
             brute_force::collideAlong(of_scan, of_model, poses, everything(0.1)));
}

/// Swept motion and what stops early set nothing aside.
TEST(Outliers, StayWhereMotionIsSwept)
{
  const test::Cloud scan(cubeWith({{1e6, 0, 0}, {0, -1e6, 0}}, 1)), model(cubeWith({{1e6, 0, 0}}, 2));
  const SphereHierarchy of_scan(scan.view()), of_model(model.view());
  constexpr double clearance = 0.05, tolerance = 0.02;
  constexpr std::size_t steps = 40;
  Poses poses = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()}, between;
  poses[1].translation().x() = 0.4;
  ASSERT_TRUE(findOutliers(of_scan, of_model, poses, clearance).has_value());
  for (std::size_t k = 0; k <= steps; ++k) {
    between.push_back(poses[0]);
    between.back().translation().x() = 0.4 * static_cast<double>(k) / steps;
  }
  TrajectoryRequest request = test::flagsOnly(clearance);
  const std::vector<Verdict> surely = brute_force::collideAlong(of_scan, of_model, between, request).flags;
  request.clearance = clearance + tolerance + 0.2 / steps;
  const std::vector<Verdict> perhaps = brute_force::collideAlong(of_scan, of_model, between, request).flags;
  request = test::flagsOnly(clearance);
  request.swept = tolerance;
  const TrajectoryResult swept = collideAlong(of_scan, of_model, poses, request);
  EXPECT_GT(swept.colliding, 5u);
  for (std::size_t i = 0; i < surely.size(); ++i) {
    EXPECT_GE(swept.flags[i], surely[i]) << i;
    EXPECT_LE(swept.flags[i], perhaps[i]) << i;
  }
  request.first_poses = request.distances = true;
  const TrajectoryResult each = collideAlong(of_scan, of_model, poses, request);
  EXPECT_EQ(each.flags, swept.flags);
  ASSERT_TRUE(each.first_contact && swept.first_contact);
  EXPECT_EQ(each.first_contact->fraction, swept.first_contact->fraction);
}

TEST(Outliers, StayWhereTheSearchStopsEarly)
{
  const test::Cloud scan(cubeWith({{1e9, 0, 0}, {0, 1e9, 0}}, 1)), model(cubeWith({{0, 1e9, 0}}, 2));
  const SphereHierarchy of_scan(scan.view()), of_model(model.view());
  const Poses poses = ahead(3, 0.2);
  TrajectoryRequest request = test::flagsOnly(0.1);
  const std::vector<Verdict> truth = brute_force::collideAlong(of_scan, of_model, poses, request).flags;
  for (const Accuracy& accuracy : {Accuracy::level(0), Accuracy::level(2), Accuracy::level(100), Accuracy::nodePairs(0),
                                   Accuracy::nodePairs(300), Accuracy::nodePairs(std::uint64_t{1} << 50)}) {
    request.accuracy = accuracy;
    const std::vector<Verdict> flags = collideAlong(of_scan, of_model, poses, request).flags;
    for (std::size_t i = 0; i < truth.size(); ++i)
      EXPECT_TRUE(flags[i] == Verdict::undecided || flags[i] == truth[i]) << i;
    if (accuracy.value > 1000) {
      EXPECT_EQ(flags, truth);
    }
  }
}

TEST(Outliers, OfASubset)
{
  const std::vector<std::int32_t> some = {3, 7, 11, 12, 13, 27, 30, 31, 40, 80, 81, 149};
  const test::Cloud scan(cubeWith({{1e20, 0, 0}, {1e20, 0, 0}}, 1)), model(cubeWith({{1e20, 0, 0}}, 2));
  PointsView subset = scan.view();
  subset.indices = some.data();
  subset.index_count = some.size();
  const SphereHierarchy of_scan(subset), of_model(model.view());
  const Poses poses = ahead(3, 0.2);
  const TrajectoryResult found = collideAlong(of_scan, of_model, poses, everything(0.3));
  expectSame(found, brute_force::collideAlong(of_scan, of_model, poses, everything(0.3)));
  EXPECT_EQ(found.flags[7], Verdict::colliding);
  EXPECT_EQ(found.flags[27], Verdict::colliding);

  // The model's own outlier is no point of its subset.
  const std::vector<std::int32_t> others = {0, 1, 2, 3, 30, 31, 40, 80, 81, 149};
  PointsView without = model.view();
  without.indices = others.data();
  without.index_count = others.size();
  const SphereHierarchy of_others(without);
  EXPECT_TRUE(findOutliers(of_scan, of_others, poses, 0.3).has_value());
  expectSame(collideAlong(of_scan, of_others, poses, everything(0.3)),
             brute_force::collideAlong(of_scan, of_others, poses, everything(0.3)));
}

} // namespace
} // namespace pcl_bsh
