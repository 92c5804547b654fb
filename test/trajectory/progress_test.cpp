// SPDX-License-Identifier: BSD-3-Clause
// Reports about a path, and how a caller ends one: an exception of its callback is its own, and harms nothing.
#include "support/journeys.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/trajectory/pose_path.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::flagsOnly;
using test::identity;
using test::Poses;
using test::Random;
using test::Shape;

struct Mine {
  int number;
};

class ProgressThreads : public testing::TestWithParam<unsigned> {
protected:
  ProgressThreads()
  {
    std::mt19937 engine(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 3 * 20000; ++i) scan_xyz.push_back(unit(engine));
    for (int i = 0; i < 3 * 500; ++i) model_xyz.push_back(0.2F * unit(engine));
    for (int i = 0; i < 20; ++i) {
      Eigen::Isometry3d pose(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()));
      pose.translation() = Eigen::Vector3d(0.1 * i - 1, 0, 0);
      poses.push_back(pose);
    }
    HierarchyOptions options;
    options.voxel_edge = 0.25;
    scan = std::make_unique<SphereHierarchy>(viewOf(scan_xyz.data(), scan_xyz.size() / 3), options);
    model = std::make_unique<SphereHierarchy>(viewOf(model_xyz.data(), model_xyz.size() / 3));
  }

  /// Every way that a query goes along a path.
  static std::vector<TrajectoryRequest> requests()
  {
    std::vector<TrajectoryRequest> all(4);
    all[1].distances = all[1].first_poses = all[1].closest_poses = all[1].pose_summaries = true;
    all[2].accuracy = Accuracy::level(2);
    all[3].accuracy = Accuracy::nodePairs(1000000);
    for (TrajectoryRequest& request : all) {
      request.clearance = 0.02;
      request.threads = GetParam();
    }
    all.push_back(all[0]);
    all.back().swept = 0.01;
    return all;
  }

  std::vector<float> scan_xyz, model_xyz;
  std::unique_ptr<SphereHierarchy> scan, model;
  std::vector<Eigen::Isometry3d> poses;
};

TEST_P(ProgressThreads, WhatACallbackThrowsComesOutUnchanged)
{
  for (TrajectoryRequest request : requests()) {
    const std::string what = request.accuracy.text() + (request.swept ? " swept" : "");
    const int last = GetParam() == 1 ? 3 : 1; // the calling thread has one voxel at least, however fast others are
    for (int at = 1; at <= last; ++at) {
      int calls = 0;
      request.progress = [&](double) -> bool {
        if (++calls == at) throw Mine{at};
        return true;
      };
      try {
        collideAlong({*scan}, *model, poses, request);
        ADD_FAILURE() << what << ": it got lost after " << calls << " calls";
      }
      catch (const Mine& mine) {
        EXPECT_EQ(mine.number, at) << what;
      }
      EXPECT_EQ(calls, at) << what << ": no call after one that threw";
    }
    // Both hierarchies are as good as new.
    request.progress = nullptr;
    const TrajectoryResult again = collideAlong({*scan}, *model, poses, request);
    const SphereHierarchy fresh_scan(viewOf(scan_xyz.data(), scan_xyz.size() / 3), scan->options());
    const SphereHierarchy fresh_model(viewOf(model_xyz.data(), model_xyz.size() / 3));
    const TrajectoryResult expected = collideAlong({fresh_scan}, fresh_model, poses, request);
    EXPECT_GT(expected.colliding, 0U) << what;
    EXPECT_EQ(again.flags, expected.flags) << what;
    EXPECT_EQ(again.first_pose, expected.first_pose) << what;
  }
}

TEST_P(ProgressThreads, FalseStopsEveryQueryAlongAPath)
{
  for (TrajectoryRequest request : requests()) {
    int calls = 0;
    request.progress = [&](double share) {
      EXPECT_GE(share, 0.0);
      EXPECT_LE(share, 1.0);
      ++calls;
      return false;
    };
    EXPECT_THROW(collideAlong({*scan}, *model, poses, request), Cancelled) << request.accuracy.text();
    EXPECT_EQ(calls, 1) << request.accuracy.text();
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, ProgressThreads, testing::Values(1U, 2U));

/// The poses of a long path, far from a scan of one voxel.
struct FarPath {
  explicit FarPath(std::size_t count)
  {
    for (std::size_t k = 0; k < count; ++k) {
      poses.push_back(identity);
      poses.back().translation() =
          Eigen::Vector3d(1000 + 0.001 * static_cast<double>(k), std::sin(0.01 * static_cast<double>(k)), 0);
    }
  }

  Cloud points{std::vector<Point3>{{0, 0, 0}, {1, 0, 0}}};
  SphereHierarchy scan{points.view()}, model{points.view()};
  Poses poses;
};

TEST(TrajectoryProgress, APathThatCannotBeMadeInTimeLeavesAllUndecided)
{
  const FarPath far(20000);
  TrajectoryRequest request = flagsOnly(0.1);
  request.accuracy = Accuracy::time(0.0);
  const TrajectoryResult nothing = collideAlong({far.scan}, far.model, far.poses, request);
  EXPECT_EQ(nothing.flags, std::vector<Verdict>(2, Verdict::undecided));
  EXPECT_EQ(nothing.undecided, 2u);
  request.accuracy = Accuracy::time(3600);
  EXPECT_EQ(collideAlong({far.scan}, far.model, far.poses, request).flags, std::vector<Verdict>(2, Verdict::free));
}

TEST(TrajectoryProgress, IsReportedWhileNothingIsNear)
{
  for (const std::size_t count : {1u, 100u, 50000u})
    for (const bool swept : {false, true}) {
      const FarPath far(count);
      TrajectoryRequest request = flagsOnly(0.1);
      if (swept) request.swept = 0.01;
      std::vector<double> fractions;
      request.progress = [&](double fraction) {
        fractions.push_back(fraction);
        return true;
      };
      EXPECT_EQ(collideAlong({far.scan}, far.model, far.poses, request).colliding, 0u);
      ASSERT_GE(fractions.size(), count > 1000 ? 10u : 1u);
      EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
      EXPECT_GE(fractions.front(), 0.0);
      EXPECT_LE(fractions.back(), 1.0);
      for (const std::size_t last : {std::size_t{1}, fractions.size() / 2 + 1, fractions.size()}) {
        std::size_t calls = 0;
        request.progress = [&](double) { return ++calls < last; };
        EXPECT_THROW(collideAlong({far.scan}, far.model, far.poses, request), Cancelled);
        EXPECT_EQ(calls, last);
      }
    }
}

TEST(TrajectoryProgress, IsReportedWhileVoxelsAreSoughtAlongThePath)
{
  Random random(6);
  const Cloud scan_points(test::makePoints(Shape::uniform, 20000, 1, random)), model_points({{0, 0, 0}});
  HierarchyOptions options;
  options.voxel_edge = 0.05;
  const SphereHierarchy scan(scan_points.view(), options), model(model_points.view());
  Poses poses;
  for (int k = 0; k < 300; ++k) poses.push_back(random.pose(0.5));
  TrajectoryRequest request = flagsOnly(0.1);
  std::size_t calls = 0;
  request.progress = [&](double fraction) {
    calls += fraction > kPathDone && fraction < kBroadPhaseDone;
    return true;
  };
  collideAlong({scan}, model, poses, request);
  EXPECT_GT(calls, 5u);
}

TEST(TrajectoryProgress, IsReportedDuringALongWalk)
{
  Random random(5);
  const Cloud scan_points(test::makePoints(Shape::uniform, 3000, 1, random)),
      model_points(test::makePoints(Shape::uniform, 200, 1, random));
  HierarchyOptions options;
  options.voxel_edge = 64.0; // eight voxels at most
  const SphereHierarchy scan(scan_points.view(), options), model(model_points.view(), options);
  Poses poses;
  for (int k = 0; k < 300; ++k) poses.push_back(random.pose(0.5));
  TrajectoryRequest request = flagsOnly(0.01);
  request.distances = true;
  for (const unsigned threads : {1u, 2u}) {
    request.threads = threads;
    std::vector<double> fractions;
    request.progress = [&](double fraction) {
      fractions.push_back(fraction);
      return true;
    };
    collideAlong({scan}, model, poses, request);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    if (threads == 1) {
      EXPECT_GT(fractions.size(), 2 * 8u);
    }
    int calls = 0;
    request.progress = [&](double) { return ++calls < 4; };
    EXPECT_THROW(collideAlong({scan}, model, poses, request), Cancelled);
    EXPECT_EQ(calls, 4);
  }
}

} // namespace
} // namespace pcl_bsh
