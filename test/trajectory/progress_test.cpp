// SPDX-License-Identifier: BSD-3-Clause
// What a caller's callback throws is the caller's, and harms nothing.
#include "support/verdicts.h"

#include <pcl_bsh/trajectory/trajectory.h>

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

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

} // namespace
} // namespace pcl_bsh
