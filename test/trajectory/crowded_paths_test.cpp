// SPDX-License-Identifier: BSD-3-Clause
// Paths over places that floats cannot tell apart: many points of both clouds within a tenth of a micrometre, in a
// scene of 200 metres.
#include "support/journeys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::everything;
using test::expectSame;
using test::flagsOnly;
using test::Poses;
using test::Random;

constexpr double kScene = 100.0;

/// Points within `width` of a place, a tenth of them anywhere in the scene.
std::vector<Point3> crowd(std::size_t count, const Point3& place, double width, Random& random)
{
  std::vector<Point3> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    points[i] =
        random.point([&] { return i % 10 == 0 ? random.uniform(-kScene, kScene) : random.uniform(-width, width); });
    for (std::size_t k = 0; i % 10 != 0 && k < 3; ++k) points[i][k] += place[k];
  }
  return points;
}

/// Poses a fraction of the crowd's width from each other, turned by as little.
Poses creeping(std::size_t count, double width, double step)
{
  Poses poses(count, Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < count; ++k) {
    const double share = step * static_cast<double>(k);
    poses[k].translation() = width * share * Eigen::Vector3d(1.0, 0.3, -0.2);
    poses[k].rotate(Eigen::AngleAxisd(1e-3 * width * share, Eigen::Vector3d(1, 2, 3).normalized()));
  }
  return poses;
}

/// Questions about a path, each by itself and all at once.
std::vector<TrajectoryRequest> requests(double clearance)
{
  std::vector<TrajectoryRequest> all(5, flagsOnly(clearance));
  all[1].first_poses = true;
  all[2].distances = true;
  all[3].pose_summaries = true;
  all[4] = everything(clearance);
  return all;
}

std::vector<float> lengths(std::size_t count, double most, Random& random)
{
  std::vector<float> some(count);
  for (float& length : some) length = static_cast<float>(random.uniform(0, most));
  return some;
}

enum class Points { bare, balls, uncertain };

void expectAsBruteForce(std::uint64_t seed, Points kind)
{
  Random random(seed);
  const double width = std::pow(10.0, random.uniform(-12, -5));
  const Point3 place = seed % 3 == 0 ? Point3{0, 0, 0} : random.point([&] { return random.uniform(-50, 50); });
  Cloud scan(crowd(260, place, width, random), {Scalar::float64, 0, 0});
  Cloud model(crowd(300, place, width, random), {Scalar::float64, 0, 0});
  if (kind == Points::balls) {
    scan.setRadii(lengths(260, 0.3 * width, random));
    model.setRadii(lengths(300, width, random));
  }
  if (kind == Points::uncertain) {
    scan.setUncertainties(0.1 * width, lengths(260, 0.2 * width, random));
    model.setUncertainties(0.0, lengths(300, 0.1 * width, random));
  }
  HierarchyOptions options; // the crowd by itself, or among others
  if (seed % 2 == 0) options.voxel_edge = random.uniform(10, 100);
  const SphereHierarchy of_scan(scan.view(), options), of_model(model.view(), options);
  const Poses poses = creeping(6, width, random.uniform(0.05, 1));
  const double clearance = width * std::pow(10.0, random.uniform(-1.5, 0.7));
  for (const TrajectoryRequest& request : requests(clearance))
    expectSame(collideAlong(of_scan, of_model, poses, request),
               brute_force::collideAlong(of_scan, of_model, poses, request));
}

TEST(CrowdedPaths, AnswerAsBruteForce)
{
  for (std::uint64_t seed = 0; seed < 6; ++seed)
    for (const Points kind : {Points::bare, Points::balls, Points::uncertain}) {
      SCOPED_TRACE(std::to_string(seed) + ", kind " + std::to_string(static_cast<int>(kind)));
      expectAsBruteForce(seed, kind);
      if (testing::Test::HasFailure()) return;
    }
}

/// A box above the voxels that holds all of the crowd: the model is nothing but the crowd, in many voxels.
TEST(CrowdedPaths, OfManyVoxelsWithinAFloat)
{
  Random random(17);
  const Point3 place = {30, 40, 50};
  std::vector<Point3> dense = crowd(1400, place, 1e-7, random), scattered = crowd(120, place, 1e-7, random);
  std::erase_if(dense, [&](const Point3& p) { return std::abs(p[0] - place[0]) > 1e-6; });
  const Cloud scan(scattered, {Scalar::float64, 0, 0}), model(dense, {Scalar::float64, 0, 0});
  HierarchyOptions fine;
  fine.voxel_edge = 2e-8;
  const SphereHierarchy of_scan(scan.view()), of_model(model.view(), fine);
  ASSERT_GT(of_model.statistics().voxels, 100u);
  for (const TrajectoryRequest& request : requests(3e-9))
    expectSame(collideAlong(of_scan, of_model, creeping(4, 1e-7, 0.3), request),
               brute_force::collideAlong(of_scan, of_model, creeping(4, 1e-7, 0.3), request));
}

double workOf(std::size_t count, const TrajectoryRequest& request)
{
  Random random(3);
  const Point3 place = {30, 40, 50};
  const Cloud scan(crowd(count, place, 1e-7, random), {Scalar::float64, 0, 0});
  const Cloud model(crowd(count, place, 1e-7, random), {Scalar::float64, 0, 0});
  const SphereHierarchy of_scan(scan.view()), of_model(model.view());
  const Work work = collideAlong(of_scan, of_model, creeping(5, 1e-7, 0.1), request).work;
  return static_cast<double>(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions);
}

/// Where each point of one crowd was compared with each of the other, work grew with the square of their number.
TEST(CrowdedPaths, WorkGrowsLittleFasterThanTheirNumber)
{
  for (const double clearance : {1e-9, 1e-7})
    for (std::size_t i = 0; const TrajectoryRequest& request : requests(clearance)) {
      SCOPED_TRACE("request " + std::to_string(i++) + ", clearance " + std::to_string(clearance * 1e9) + "e-9");
      EXPECT_LT(std::log2(workOf(6000, request) / workOf(1500, request)) / 2, 1.3);
    }
}

} // namespace
} // namespace pcl_bsh
