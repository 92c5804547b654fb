// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/progress.h>

#include <gmock/gmock.h>

#include <vector>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;

/// What a caller is told.
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
  EXPECT_FALSE(progress.pulse());
  progress.step();
  progress.step(); // more than there are
  progress.finish();
  EXPECT_THAT(told.shares, ElementsAre(0.125, 0.25, 0.5, 0.625, 0.875, 1.0, 1.0, 1.0));
}

TEST(Progress, TellsOfManySmallPiecesNowAndThen)
{
  constexpr std::size_t many = std::size_t{1} << 15;
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
  EXPECT_FALSE(progress.pulse());
  progress.throwIfStopped();
  EXPECT_TRUE(progress.pulse());
  EXPECT_TRUE(progress.stopped());
  EXPECT_THROW(progress.throwIfStopped(), Cancelled);
  EXPECT_THROW(progress.end(), Cancelled);
  EXPECT_FALSE(progress.nested()(0.5));
  EXPECT_EQ(told.shares.size(), 2u) << "it is not asked again";
}

TEST(Progress, OfNobodyTellsNothing)
{
  const std::function<bool(double)> none;
  Progress progress(none);
  progress.begin(1.0, 1);
  progress.step();
  progress.finish();
  EXPECT_FALSE(progress.nested());
}

TEST(SearchPulse, TellsHowMuchOfTheStackIsLeft)
{
  Told told;
  Progress progress(told.report);
  SearchPulse pulse({&progress, 1.0}, 8);
  for (int step = 1; step <= 192; ++step) pulse.step(step < 100 ? 6 : 2);
  EXPECT_THAT(told.shares, ElementsAre(0.25, 0.75, 0.75));
  SearchPulse of_a_step({&progress, 0.0}, 8); // tells nothing of its own
  for (int step = 1; step <= 64; ++step) of_a_step.step(1);
  EXPECT_THAT(told.shares, ElementsAre(0.25, 0.75, 0.75, 0.75));
  SearchPulse of_nobody({}, 8);
  for (int step = 1; step <= 200; ++step) of_nobody.step(1);
  told.most = 5;
  SearchPulse stopped({&progress, 1.0}, 8);
  for (int step = 1; step < 64; ++step) stopped.step(1);
  EXPECT_THROW(stopped.step(1), Cancelled);
}

} // namespace
} // namespace pcl_bsh
