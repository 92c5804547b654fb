// SPDX-License-Identifier: BSD-3-Clause
// How stages run: in which order, at the same time, what they hold and what they report.
#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/io/json/json_document.h>

#include "../filters/clouds.h"
#include "io/clouds/samples.h"
#include "run_stage.h"

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace pcl_bsh::pipeline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// The actions of the stages below; reset by each test.
struct Stage2Stage {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::weak_ptr<const StageCloud>> seen;
  std::vector<std::size_t> alive; ///< of `seen`, whenever a stage begins
  unsigned meeting = 0, expected = 2;
  std::atomic<int> loops{0};
};
Stage2Stage shared;

/// A new cloud like its input, which it remembers without holding it.
struct Copy : Stage {
  std::string warning;
  StageCloudPtr run(StageClouds&& inputs) override
  {
    const std::lock_guard lock(shared.mutex);
    shared.seen.push_back(inputs[0]);
    std::size_t alive = 0;
    for (const auto& cloud : shared.seen) alive += cloud.expired() ? 0 : 1;
    shared.alive.push_back(alive);
    if (!warning.empty()) warn(warning);
    return std::make_shared<StageCloud>(*inputs[0]);
  }
};

/// Ends only when as many as expected run at the same time.
struct Meet : Stage {
  StageCloudPtr run(StageClouds&& inputs) override
  {
    std::unique_lock lock(shared.mutex);
    ++shared.meeting;
    shared.changed.notify_all();
    const auto all_here = [] { return shared.meeting >= shared.expected; };
    if (!shared.changed.wait_for(lock, std::chrono::seconds(20), all_here)) throw std::runtime_error("was alone");
    return inputs[0];
  }
};

struct Fail : Stage {
  StageCloudPtr run(StageClouds&&) override { throw std::runtime_error("went wrong: mend it"); }
};

struct Grow : Stage {
  StageCloudPtr run(StageClouds&&) override { throw std::bad_alloc(); }
};

/// Goes on with its loop when the other stage has failed.
struct Loop : Stage {
  static constexpr int count = 1000;
  StageCloudPtr run(StageClouds&& inputs) override
  {
    std::unique_lock lock(shared.mutex);
    shared.meeting = 1;
    shared.changed.notify_all();
    shared.changed.wait_for(lock, std::chrono::seconds(20), [] { return shared.meeting == 2; });
    lock.unlock();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    tbb::parallel_for(0, count, [](int) { ++shared.loops; });
    return inputs[0];
  }
};

/// Fails while the other stage works.
struct FailLater : Stage {
  StageCloudPtr run(StageClouds&&) override
  {
    std::unique_lock lock(shared.mutex);
    shared.changed.wait_for(lock, std::chrono::seconds(20), [] { return shared.meeting == 1; });
    shared.meeting = 2;
    shared.changed.notify_all();
    throw std::runtime_error("went wrong: mend it");
  }
};

struct Nothing : Stage {
  StageCloudPtr run(StageClouds&&) override { return nullptr; }
};

/// Turns its own input over, in place when it may.
struct InPlace : Stage {
  StageCloudPtr run(StageClouds&& inputs) override
  {
    const void* before = inputs[0].get();
    auto cloud = ownCloud(std::move(inputs[0]));
    warn(cloud.get() == before ? "in place" : "copied");
    return cloud;
  }
};

const bool registered =
    registerStage(describe<Copy>("filters.test_copy", "").option(&Copy::warning, "warning", "")) &&
    registerStage(describe<Meet>("filters.test_meet", "")) && registerStage(describe<Fail>("filters.test_fail", "")) &&
    registerStage(describe<Grow>("filters.test_grow", "")) && registerStage(describe<Loop>("filters.test_loop", "")) &&
    registerStage(describe<FailLater>("filters.test_fail_later", "")) &&
    registerStage(describe<Nothing>("filters.test_nothing", "")) &&
    registerStage(describe<InPlace>("filters.test_in_place", ""));

StageCloudPtr someCloud(std::size_t points = 100)
{
  auto cloud = std::make_shared<StageCloud>();
  cloud->cloud = *test::fieldCloud<float>(test::randomPoints(points, 1));
  return cloud;
}

Pipeline pipelineOf(const std::string& stages, const StageCloudPtr& cloud)
{
  Pipeline pipeline = Pipeline::parse(R"([{"filename": "in.pcd", "tag": "in"}, )" + stages + "]", {}, "p.json");
  pipeline.setCloud("in", cloud);
  return pipeline;
}

class RunGraph : public testing::Test {
protected:
  RunGraph()
  {
    EXPECT_TRUE(registered);
    shared.seen.clear();
    shared.alive.clear();
    shared.meeting = 0;
    shared.expected = 2;
    shared.loops = 0;
  }
};

TEST_F(RunGraph, FreesACloudOnceItsLastReaderIsDone)
{
  Pipeline pipeline = pipelineOf(R"({"type": "filters.test_copy"}, {"type": "filters.test_copy"},
                                    {"type": "filters.test_copy"}, {"type": "filters.test_copy"})",
                                 someCloud());
  const PipelineResult result = pipeline.run();
  // The first cloud is ours; of the others, only the one at hand lives.
  EXPECT_THAT(shared.alive, ElementsAre(1, 2, 2, 2));
  ASSERT_EQ(shared.seen.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_TRUE(shared.seen[i].expired()) << i;
  EXPECT_THAT(result.clouds, SizeIs(1));
}

TEST_F(RunGraph, KeepsACloudForItsLastReader)
{
  Pipeline pipeline =
      pipelineOf(R"({"type": "filters.test_copy", "tag": "a"}, {"type": "filters.test_copy", "tag": "b"},
                                    {"type": "filters.test_copy", "tag": "c", "inputs": ["b"]},
                                    {"type": "filters.merge", "inputs": ["a", "c", "in"]})",
                 someCloud());
  pipeline.setNumberOfThreads(1);
  const PipelineResult result = pipeline.run();
  EXPECT_EQ(result.clouds.begin()->second->cloud.width, 300U);
  for (std::size_t i = 1; i < shared.seen.size(); ++i) EXPECT_TRUE(shared.seen[i].expired()) << i;
}

TEST_F(RunGraph, WorksInPlaceWhereNobodyElseReads)
{
  const StageCloudPtr cloud = someCloud();
  const auto warnings = [&](const std::string& stages) { return pipelineOf(stages, cloud).run().warnings; };
  EXPECT_THAT(warnings(R"({"type": "filters.test_in_place", "tag": "a"})"), ElementsAre("a: copied"))
      << "the caller holds it";
  EXPECT_THAT(warnings(R"({"type": "filters.test_copy"}, {"type": "filters.test_in_place", "tag": "a"})"),
              ElementsAre("a: in place"));
}

TEST_F(RunGraph, BranchesRunAtTheSameTime)
{
  Pipeline pipeline = pipelineOf(R"({"type": "filters.test_meet", "tag": "a", "inputs": ["in"]},
                                    {"type": "filters.test_meet", "tag": "b", "inputs": ["in"]},
                                    {"type": "filters.merge", "inputs": ["a", "b"]})",
                                 someCloud());
  pipeline.setNumberOfThreads(2);
  EXPECT_EQ(pipeline.run().clouds.begin()->second->cloud.width, 200U);
}

TEST_F(RunGraph, MoreStagesThanTheMachineHasThreadsRunAtTheSameTime)
{
  const unsigned threads = std::thread::hardware_concurrency() + 2;
  std::string stages, tags;
  for (unsigned i = 0; i < threads; ++i) {
    const std::string tag = "meet" + std::to_string(i);
    stages += R"({"type": "filters.test_meet", "inputs": ["in"], "tag": ")" + tag + "\"}, ";
    tags += (i == 0 ? "\"" : ", \"") + tag + "\"";
  }
  Pipeline pipeline = pipelineOf(stages + R"({"type": "filters.merge", "inputs": [)" + tags + "]}", someCloud(10));
  pipeline.setNumberOfThreads(threads);
  shared.expected = threads;
  EXPECT_EQ(pipeline.run().clouds.begin()->second->cloud.width, 10 * threads);
}

TEST_F(RunGraph, OneThreadRunsTheLowestReadyStageFirst)
{
  Pipeline pipeline = pipelineOf(R"({"type": "filters.test_copy", "tag": "a", "inputs": ["in"]},
                                    {"type": "filters.test_copy", "tag": "b", "inputs": ["a"]},
                                    {"type": "filters.test_copy", "tag": "c", "inputs": ["in"]},
                                    {"type": "filters.test_copy", "tag": "d", "inputs": ["b"]},
                                    {"type": "filters.merge", "tag": "e", "inputs": ["c", "d"]})",
                                 someCloud());
  pipeline.setNumberOfThreads(1);
  std::string begun;
  pipeline.setProgress([&](const StageProgress& stage) {
    if (!stage.done) begun += stage.tag + ' ';
  });
  pipeline.run();
  EXPECT_EQ(begun, "in a b c d e ");
}

/// A stage that fails must not cut short the parallel loop of one that still runs.
TEST_F(RunGraph, AFailureLeavesLoopsOfOtherStagesWhole)
{
  Pipeline pipeline = pipelineOf(R"({"type": "filters.test_loop", "tag": "a", "inputs": ["in"]},
                                    {"type": "filters.test_fail_later", "tag": "b", "inputs": ["in"]},
                                    {"type": "filters.merge", "inputs": ["a", "b"]})",
                                 someCloud());
  pipeline.setNumberOfThreads(2);
  EXPECT_EQ(errorOf([&] { pipeline.run(); }), "p.json: b: /2: went wrong: mend it");
  EXPECT_EQ(shared.loops, Loop::count);
}

TEST_F(RunGraph, NamesTheStageThatFails)
{
  EXPECT_EQ(errorOf([] { pipelineOf(R"({"type": "filters.test_fail", "tag": "bad"})", someCloud()).run(); }),
            "p.json: bad: /1: went wrong: mend it");
  EXPECT_EQ(errorOf([] { pipelineOf(R"({"type": "filters.test_nothing"})", someCloud()).run(); }),
            "p.json: filters_test_nothing1: /1: gave no cloud: let its run() return one");
  EXPECT_EQ(errorOf([] { pipelineOf(R"({"type": "filters.test_grow", "tag": "large"})", someCloud()).run(); }),
            "p.json: large: /1: there is too little memory: give smaller clouds or a larger machine");
}

TEST_F(RunGraph, WritesNothingAfterAFailure)
{
  const io::TemporaryFolder folder;
  const std::string out = (folder / "out.pcd").string();
  EXPECT_THROW(
      pipelineOf(R"({"type": "filters.test_fail"}, {"type": "writers.pcd", "filename": ")" + out + "\"}", someCloud())
          .run(),
      PipelineError);
  EXPECT_EQ(folder.files(), 0U);
}

TEST_F(RunGraph, AWriterMayStandInBetween)
{
  const io::TemporaryFolder folder;
  const std::string out = (folder / "out.pcd").string();
  const PipelineResult result =
      pipelineOf(R"({"type": "writers.pcd", "filename": ")" + out + R"("}, {"type": "filters.test_copy"})", someCloud())
          .run();
  EXPECT_EQ(io::readCloud(out).width, 100U);
  EXPECT_THAT(result.clouds, SizeIs(1));
}

TEST_F(RunGraph, TellsProgress)
{
  Pipeline pipeline = pipelineOf(
      R"({"type": "filters.test_copy", "tag": "a"}, {"type": "filters.test_copy", "tag": "b"})", someCloud(7));
  std::vector<std::string> told;
  pipeline.setProgress([&](const StageProgress& stage) {
    told.push_back(stage.tag + (stage.done ? " done " + std::to_string(stage.points) : " begins"));
    EXPECT_EQ(stage.stages, 3U);
  });
  pipeline.run();
  EXPECT_THAT(told, ElementsAre("in begins", "in done 7", "a begins", "a done 7", "b begins", "b done 7"));
}

/// Not even of a stage that was at work when it threw.
TEST_F(RunGraph, IsNotCalledAgainAfterItHasThrown)
{
  Pipeline pipeline = pipelineOf(R"({"type": "filters.test_meet", "tag": "a", "inputs": ["in"]},
                                    {"type": "filters.test_meet", "tag": "b", "inputs": ["in"]},
                                    {"type": "filters.merge", "inputs": ["a", "b"]})",
                                 someCloud());
  pipeline.setNumberOfThreads(2);
  int calls_after = 0;
  bool has_thrown = false;
  pipeline.setProgress([&](const StageProgress& stage) {
    calls_after += has_thrown ? 1 : 0;
    if (!stage.done || stage.tag == "in" || has_thrown) return;
    has_thrown = true;
    throw std::runtime_error("enough");
  });
  EXPECT_THROW(pipeline.run(), std::runtime_error);
  EXPECT_TRUE(has_thrown);
  EXPECT_EQ(calls_after, 0);
}

TEST_F(RunGraph, MetadataSaysWhatRanAndRunsAgain)
{
  const io::TemporaryFolder folder;
  const auto file = [&](const std::string& name) { return (folder / name).string(); };
  io::writeCloud(file("in.pcd"), someCloud(500)->cloud);
  io::writeCloud(file("robot.pcd"), someCloud(50)->cloud);
  const std::string json = R"({"pipeline": [")" + file("in.pcd") + R"(",
      {"type": "pcl::VoxelGrid", "tag": "thin", "leaf_size": 0.2, "user_data": "kept"},
      {"type": "filters.bsh_flag", "obstacle": ")" +
                           file("robot.pcd") + R"(", "clearance": 0.1},
      {"type": "filters.test_copy", "warning": "look"}, ")" +
                           file("out.pcd") + R"("]})";
  const PipelineResult first = Pipeline::parse(json).run();
  const pcl::PCLPointCloud2 expected = io::readCloud(file("out.pcd"));

  const io::Json metadata = io::parseJson(first.metadata);
  EXPECT_EQ(metadata["pipeline"].size(), 5U);
  EXPECT_EQ(metadata["pipeline"][1]["minimum_points_number_per_voxel"], 0);
  EXPECT_EQ(metadata["pipeline"][1]["user_data"], "kept");
  const io::Json& stages = metadata["metadata"]["stages"];
  ASSERT_EQ(stages.size(), 6U) << "the obstacle's reader is a stage, too";
  EXPECT_EQ(stages[0]["points_out"], 500);
  EXPECT_EQ(stages[1]["points_in"], 500);
  EXPECT_EQ(stages[1]["points_out"], expected.width);
  EXPECT_GT(stages[1]["seconds"].get<double>(), 0);
  EXPECT_GT(stages[1]["bytes_out"], 0);
  EXPECT_GT(stages[1]["resident_bytes_after"], 0);
  EXPECT_EQ(stages[4]["warnings"].dump(), "[\"look\"]");
  EXPECT_GT(metadata["metadata"]["peak_bytes"], 0);

  std::filesystem::remove(file("out.pcd"));
  Pipeline::parse(first.metadata).run();
  io::expectSame(io::readCloud(file("out.pcd")), expected);
}

TEST_F(RunGraph, RunsTwice)
{
  Pipeline pipeline = pipelineOf(R"({"type": "filters.test_copy", "warning": "once"})", someCloud());
  EXPECT_THAT(pipeline.run().warnings, SizeIs(1));
  EXPECT_THAT(pipeline.run().warnings, SizeIs(1));
}

TEST_F(RunGraph, CloudsAreGivenToReadersOnly)
{
  Pipeline pipeline = pipelineOf(R"({"type": "filters.test_copy", "tag": "a"})", someCloud());
  EXPECT_EQ(errorOf([&] { pipeline.setCloud("inn", someCloud()); }),
            "p.json: no reader has the tag 'inn': did you mean 'in'?");
  EXPECT_THAT(errorOf([&] { pipeline.setCloud("in", nullptr); }), HasSubstr("the cloud is null"));
}

} // namespace
} // namespace pcl_bsh::pipeline
