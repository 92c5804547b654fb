// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/query/progress.h>

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;

/// The reports that a caller gets.
struct Told {
  std::vector<double> shares;
  std::size_t most = 1000; ///< then it says that it has enough
  const std::function<bool(double)> report = [this](double share) {
    shares.push_back(share);
    return shares.size() < most;
  };
};

TEST(Progress, IsThatOfItsPartsOneAfterTheOther)
{
  Told told;
  Progress progress(told.report);
  progress.begin(0.5, 4);
  progress.step();
  progress.step();
  progress.end();
  progress.begin(1.0, 4);
  progress.step();
  progress.skipTo(3);
  progress.ask();
  progress.step();
  progress.step(); // more than there are
  progress.finish();
  EXPECT_THAT(told.shares, ElementsAre(0.125, 0.25, 0.5, 0.625, 0.875, 1.0, 1.0, 1.0));
}

TEST(Progress, TellsOfManySmallPiecesNowAndThen)
{
  constexpr std::size_t many = kPairsOfPulse;
  Told told;
  Progress progress(told.report);
  progress.begin(1.0, 8);
  progress.tick(many - 1, 1);
  progress.tick(0, 1);
  EXPECT_TRUE(told.shares.empty());
  progress.tick(1);
  progress.tick(many, 2);
  EXPECT_THAT(told.shares, ElementsAre(0.25, 0.5));
  const StopRule over(Accuracy::time(0.0));
  progress.limit(&over);
  progress.tick(1);
  EXPECT_THROW(progress.tick(many), OutOfTime);
  progress.limit(nullptr);
  progress.tick(many);
  told.most = 0;
  EXPECT_THROW(progress.tick(many), Cancelled);
}

TEST(Progress, EndsWhereTheCallerHasEnough)
{
  Told told;
  told.most = 2;
  Progress progress(told.report);
  progress.begin(1.0, 4);
  progress.ask();
  progress.throwIfStopped();
  EXPECT_THROW(progress.ask(), Cancelled);
  EXPECT_TRUE(progress.stopped());
  EXPECT_THROW(progress.throwIfStopped(), Cancelled);
  EXPECT_THROW(progress.end(), Cancelled);
  EXPECT_EQ(told.shares.size(), 2u) << "it is not asked again";
}

TEST(Progress, OfNobodyTellsNothing)
{
  const std::function<bool(double)> none;
  Progress progress(none);
  progress.begin(1.0, 1);
  progress.step();
  progress.finish();
}

TEST(Progress, TellsTheWholeOfQueriesThatReportForThemselves)
{
  Told told;
  Progress progress(told.report);
  progress.tellWhole(0.25);
  progress.ask();
  progress.tellWhole(0.5);
  EXPECT_THAT(told.shares, ElementsAre(0.25, 0.25, 0.5));
  told.most = 0;
  EXPECT_THROW(progress.tellWhole(0.75), Cancelled);
}

TEST(Progress, OfANestedQueryAsksTheOuterOne)
{
  Told told;
  Progress outer(told.report);
  outer.begin(1.0, 4);
  outer.skipTo(1);
  const std::function<bool(double)> none;
  {
    Progress inner(none);
    inner.begin(1.0, 100);
    inner.step();
    askWatcher();
    EXPECT_THAT(told.shares, ElementsAre(0.25)) << "which tells nothing of the inner one";
    for (int i = 1; i < 64; ++i) inner.step();
    EXPECT_THAT(told.shares, ElementsAre(0.25, 0.25)) << "many steps ask once";
    told.most = 0;
    EXPECT_THROW(askWatcher(), Cancelled);
  }
  EXPECT_THROW(askWatcher(), Cancelled) << "now of the outer one itself";
  EXPECT_EQ(told.shares.size(), 3u);
}

TEST(Progress, LetsAReportAskQueriesOfItsOwn)
{
  int asked = 0;
  const std::function<bool(double)> report = [&](double) {
    EXPECT_EQ(watcherOfThread(), nullptr);
    askWatcher(); // nobody
    return ++asked < 3;
  };
  Progress progress(report);
  askWatcher();
  askWatcher();
  EXPECT_THROW(askWatcher(), Cancelled);
  EXPECT_EQ(asked, 3);
}

TEST(Progress, LetsWhatAReportThrowsComeOutOfEachThread)
{
  const std::function<bool(double)> report = [](double) -> bool { throw std::out_of_range("enough"); };
  Progress progress(report);
  EXPECT_THROW(askWatcher(), std::out_of_range);
  std::thread([&] {
    const Watched watched(&progress);
    EXPECT_THROW(askWatcher(), std::out_of_range);
  }).join();
  EXPECT_THROW(progress.throwIfStopped(), std::out_of_range);
}

TEST(Pulse, AsksAfterSoManyPairs)
{
  Told told;
  Progress progress(told.report);
  Pulse pulse;
  pulse.count(kPairsOfPulse - 1);
  EXPECT_TRUE(told.shares.empty());
  pulse.count(1);
  EXPECT_EQ(told.shares.size(), 1u);
  pulse.count(3 * kPairsOfPulse);
  EXPECT_EQ(told.shares.size(), 2u);
  told.most = 2;
  EXPECT_THROW(pulse.count(kPairsOfPulse), Cancelled);
}

TEST(WorkPulse, AsksAfterSoMuchWork)
{
  Told told;
  Progress progress(told.report);
  Work work;
  WorkPulse pulse(work);
  for (int i = 0; i < 1000; ++i) pulse.step(); // of nothing
  EXPECT_TRUE(told.shares.empty());
  work.node_pairs = kPairsOfPulse;
  pulse.look();
  EXPECT_EQ(told.shares.size(), 1u);
  pulse.look();
  EXPECT_EQ(told.shares.size(), 1u);
  work.exact_decisions = kPairsOfPulse / 16;
  for (int i = 0; i < 64; ++i) pulse.step();
  EXPECT_EQ(told.shares.size(), 2u);
  work.leaf_pairs = kPairsOfPulse / 16;
  work.volumes_built = kPairsOfPulse / 4;
  pulse.look();
  pulse.look();
  EXPECT_EQ(told.shares.size(), 3u);
}

TEST(SearchPulse, TellsHowMuchOfTheStackIsLeft)
{
  Told told;
  Progress progress(told.report);
  Work work;
  SearchPulse pulse({&progress, 1.0}, 8, work);
  for (int step = 1; step <= 3; ++step) {
    work.node_pairs += kPairsOfPulse;
    pulse.step(step == 1 ? 6 : 2);
  }
  EXPECT_THAT(told.shares, ElementsAre(0.25, 0.25, 0.75, 0.75, 0.75)) << "of each eighth, and of so much work";
  SearchPulse of_a_step({}, 8, work); // tells nothing of its own
  work.node_pairs += kPairsOfPulse;
  of_a_step.step(1);
  EXPECT_EQ(told.shares.size(), 6u);
  told.most = 6;
  SearchPulse stopped({&progress, 1.0}, 8, work);
  work.node_pairs += kPairsOfPulse;
  EXPECT_THROW(stopped.step(1), Cancelled);
}

/// The thread that asks has nothing to do, and another one goes on for long.
TEST(ParallelFor, AsksWhileItWaits)
{
  std::atomic<int> asked{0};
  const std::thread::id caller = std::this_thread::get_id();
  const std::function<bool(double)> report = [&](double) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    return ++asked < 3;
  };
  Progress progress(report);
  std::atomic<bool> others{false};
  const auto body = [&](std::size_t) {
    if (std::this_thread::get_id() == caller) {
      for (int i = 0; i < 1000 && !others; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return;
    }
    others = true;
    for (;;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      askWatcher();
    }
  };
  for (int i = 0; i < 100 && !others; ++i) // the system may give the other thread nothing to do
    try {
      parallelFor(2, 2, body);
    }
    catch (const Cancelled&) {
    }
  if (others) {
    EXPECT_EQ(asked, 3);
    EXPECT_TRUE(progress.stopped());
  }
}

} // namespace
} // namespace pcl_bsh
