// SPDX-License-Identifier: BSD-3-Clause
// Runs that end early: on request, and by callbacks that throw.
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/filters/pipeline/stage_type.h>

#include "../filters/clouds.h"
#include "io/clouds/samples.h"
#include "run_stage.h"

#include <pcl_bsh/io/poses/pose_file.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

namespace pcl_bsh::pipeline {
namespace {

std::atomic<int> waiting{0};

/// Works until it is told to stop.
struct Endless : Stage {
  StageCloudPtr run(StageClouds&&) override
  {
    ++waiting;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!isCancelled() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    if (!isCancelled()) throw std::runtime_error("was never told to stop");
    throw Cancelled();
  }
};

const bool registered = registerStage(describe<Endless>("filters.test_endless", ""));

StageCloudPtr someCloud(std::size_t points = 100, std::uint32_t seed = 1)
{
  auto cloud = std::make_shared<StageCloud>();
  cloud->cloud = *test::fieldCloud<float>(test::randomPoints(points, seed));
  return cloud;
}

class Cancel : public testing::TestWithParam<unsigned> {
protected:
  Cancel()
  {
    EXPECT_TRUE(registered);
    waiting = 0;
  }

  /// Two branches of merges that end in one.
  Pipeline branches() const
  {
    return pipeline(R"({"type": "filters.merge", "tag": "a", "inputs": ["in"]},
      {"type": "filters.merge", "tag": "b", "inputs": ["in"]}, {"type": "filters.merge", "inputs": ["a", "b"]})");
  }

  static Pipeline pipeline(const std::string& stages)
  {
    Pipeline made = Pipeline::parse(R"([{"filename": "in.pcd", "tag": "in"}, )" + stages + "]", {}, "p.json");
    made.setCloud("in", someCloud());
    made.setNumberOfThreads(GetParam());
    return made;
  }

  static void expectRight(Pipeline& made)
  {
    made.setProgress(nullptr);
    const PipelineResult result = made.run();
    ASSERT_EQ(result.clouds.size(), 1U);
    EXPECT_EQ(result.clouds.begin()->second->cloud.width, 200U);
  }

  const io::TemporaryFolder folder;
};

struct Mine {
  int number;
};

TEST_P(Cancel, WhatTheCallbackThrowsComesOutOfRunUnchanged)
{
  Pipeline made = branches();
  for (int at = 1; at <= 8; ++at) { // two calls for each of four stages
    int calls = 0;
    made.setProgress([&](const StageProgress&) {
      if (++calls == at) throw Mine{at};
    });
    try {
      made.run();
      ADD_FAILURE() << "it got lost at call " << at;
    }
    catch (const Mine& mine) {
      EXPECT_EQ(mine.number, at);
    }
    EXPECT_EQ(calls, at) << "no call after one that threw";
  }
  expectRight(made);
}

TEST_P(Cancel, TheCallbackMayCancel)
{
  Pipeline made = branches();
  for (const std::string begin : {"in", "a", "b", "filters_merge1"}) {
    made.setProgress([&](const StageProgress& stage) {
      if (stage.tag == begin && !stage.done) made.cancel();
    });
    EXPECT_THROW(made.run(), Cancelled) << begin;
  }
  expectRight(made);
}

TEST_P(Cancel, NoStageIsSaidToBeginAfterIt)
{
  Pipeline made = branches();
  bool is_cancelled = false;
  made.setProgress([&](const StageProgress& stage) {
    EXPECT_FALSE(is_cancelled) << stage.tag;
    if (stage.tag == "in" && stage.done) {
      made.cancel();
      is_cancelled = true;
    }
  });
  EXPECT_THROW(made.run(), Cancelled);
  EXPECT_TRUE(is_cancelled);
  expectRight(made);
}

TEST_P(Cancel, AnotherThreadMayCancelWhileStagesWork)
{
  Pipeline made = pipeline(R"({"type": "filters.test_endless", "tag": "a", "inputs": ["in"]},
      {"type": "filters.test_endless", "tag": "b", "inputs": ["in"]}, {"type": "filters.merge", "inputs": ["a", "b"]})");
  for (int run = 0; run < 2; ++run) {
    waiting = 0;
    std::jthread other([&] {
      while (waiting == 0) std::this_thread::yield();
      made.cancel();
    });
    EXPECT_THROW(made.run(), Cancelled);
  }
}

TEST_P(Cancel, ARequestBeforeARunEndsThatRunAlone)
{
  Pipeline made = branches();
  made.cancel();
  made.cancel();
  EXPECT_THROW(made.run(), Cancelled);
  expectRight(made);
}

TEST_P(Cancel, ARequestThatComesTooLateIsForgotten)
{
  Pipeline made = branches();
  made.setProgress([&](const StageProgress& stage) {
    if (stage.finished == stage.stages) made.cancel();
  });
  EXPECT_EQ(made.run().clouds.size(), 1U);
  expectRight(made);
}

TEST_P(Cancel, QueriesAlongATrajectoryStop)
{
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 100; ++i) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.05 * i, Eigen::Vector3d::UnitZ()));
    poses.push_back(pose);
  }
  io::writePoses(folder / "track.txt", poses);
  Pipeline made =
      pipeline(R"({"type": "filters.bsh_flag", "obstacle": "in", "clearance": 0.1, "tag": "flag", "trajectory": ")" +
               (folder / "track.txt").string() + R"("}, {"type": "writers.pcd", "filename": ")" +
               (folder / "out.pcd").string() + R"("})");
  made.setCloud("in", someCloud(3000));
  std::jthread other;
  made.setProgress([&](const StageProgress& stage) {
    if (stage.tag == "flag" && !stage.done) other = std::jthread([&made] { made.cancel(); });
  });
  EXPECT_THROW(made.run(), Cancelled);
  EXPECT_EQ(folder.files(), 1U) << "nothing is written";

  // The query alone, told before it begins: its first report ends it.
  const StageType& type = *findStageType("filters.bsh_flag");
  const std::unique_ptr<Stage> stage = type.make();
  type.findOption("clearance")->set(*stage, 0.1);
  type.findOption("trajectory")->set(*stage, (folder / "track.txt").string());
  type.findOption("obstacle")->set(*stage, std::string("other"));
  type.findOption("obstacle")->cloud(*stage, 0)->cloud = someCloud();
  stage->plan({emptyLike(*someCloud())->cloud});
  std::atomic<bool> cancelled = true;
  stage->watch(&cancelled);
  EXPECT_THROW(stage->run({someCloud(3000)}), Cancelled);
  cancelled = false;
  EXPECT_NO_THROW(stage->run({someCloud(300)}));
}

TEST_P(Cancel, AStageThatFailsIsToldThoughOthersGoOn)
{
  Pipeline made = branches();
  made.setProgress([&](const StageProgress& stage) {
    if (stage.tag == "b" && !stage.done) throw std::runtime_error("mine");
  });
  EXPECT_THROW(made.run(), std::runtime_error);
  expectRight(made);
}

INSTANTIATE_TEST_SUITE_P(Threads, Cancel, testing::Values(1U, 2U, 4U));

} // namespace
} // namespace pcl_bsh::pipeline
