// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/accuracy/rivals.h>

#include <gtest/gtest.h>

namespace pcl_bsh::accuracy {
namespace {

Measurement at(const std::string& setting, double seconds, double error, bool peer = false)
{
  Measurement m;
  m.query = "distance";
  m.setting = setting;
  m.seconds = m.once = {seconds, seconds, seconds};
  m.peer = peer;
  m.certified = !peer;
  (peer ? m.actual_error : m.certified_error) = error;
  return m;
}

TEST(AccuracyRivals, AnswerAPeerByTheFastestThatIsCertifiedToItsError)
{
  Study study;
  study.measurements = {at("exact", 1e-4, 0.0), at("tolerance=0.1", 2e-5, 0.1), at("tolerance=0.03", 5e-5, 0.03),
                        at("fine", 4e-5, 0.05, true), at("coarse", 3e-5, 0.2, true)};
  const std::vector<Rival> rivals = rivalsOf(study);
  ASSERT_EQ(rivals.size(), 2u);
  EXPECT_EQ(rivals[0].peer->setting, "fine");
  EXPECT_EQ(rivals[0].ours->setting, "tolerance=0.03");
  EXPECT_FALSE(rivals[0].isMet());
  EXPECT_EQ(rivals[1].ours->setting, "tolerance=0.1");
  EXPECT_TRUE(rivals[1].isMet());
}

TEST(AccuracyRivals, NoneIsMetWhereNothingIsAsAccurate)
{
  Study study;
  study.measurements = {at("tolerance=0.1", 2e-5, 0.1), at("fine", 1.0, 0.05, true)};
  const std::vector<Rival> rivals = rivalsOf(study);
  ASSERT_EQ(rivals.size(), 1u);
  EXPECT_EQ(rivals[0].ours, nullptr);
  EXPECT_FALSE(rivals[0].isMet());
}

TEST(AccuracyRivals, OnceIsAnotherChoiceThanAgain)
{
  Study study;
  study.measurements = {at("exact", 1e-4, 0.0), at("tolerance=0.1", 2e-5, 0.1), at("thin", 3e-5, 0.2, true)};
  study.measurements[0].once.median = 2e-3;
  study.measurements[1].once.median = 3e-3;
  study.measurements[2].once.median = 2.5e-3;
  const Rival rival = rivalsOf(study).front();
  EXPECT_EQ(rival.ours->setting, "tolerance=0.1");
  EXPECT_EQ(rival.once->setting, "exact");
  EXPECT_TRUE(rival.isMetOnce());
  study.measurements[2].once.median = 1.9e-3;
  EXPECT_FALSE(rivalsOf(study).front().isMetOnce());
  EXPECT_TRUE(rivalsOf(study).front().isMet());
}

TEST(AccuracyRivals, FlagsAreNotAnsweredByATolerance)
{
  Study study;
  study.measurements = {at("exact", 1e-4, 0.0), at("tolerance=0.1", 2e-5, 0.0), at("level=3", 3e-5, 0.01),
                        at("thin", 5e-5, 0.02, true), at("distance", 1e-6, 0.0)};
  for (Measurement& m : study.measurements) m.query = m.setting == "distance" ? "distance" : "flags";
  study.measurements[1].knob = "tolerance";
  const std::vector<Rival> rivals = rivalsOf(study);
  ASSERT_EQ(rivals.size(), 1u);
  EXPECT_EQ(rivals[0].ours->setting, "level=3");
}

TEST(AccuracyRivals, ASpreadIsThatOfThePosesMedians)
{
  const Spread poses = spreadOfPoses({{1, 1, 90}, {2, 2, 2}, {3, 3, 3}, {80, 4, 4}, {5, 5, 5}});
  EXPECT_EQ(poses.low, 2.0);
  EXPECT_EQ(poses.median, 3.0);
  EXPECT_EQ(poses.high, 4.0);
  const Spread one = spreadOfPoses({{5, 1, 2, 4, 3}});
  EXPECT_EQ(one.low, 2.0);
  EXPECT_EQ(one.high, 4.0);
}

TEST(AccuracyRivals, ASettingIsBeatenWhereAnotherIsFasterByMoreThanNoise)
{
  Study study;
  study.measurements = {at("exact", 1e-4, 0.0), at("tolerance=1", 1.1e-5, 0.3), at("time=1e-05", 1.3e-5, 5.5),
                        at("level=3", 1.12e-5, 0.4)};
  const std::vector<Beaten> beaten = beatenOf(study);
  ASSERT_EQ(beaten.size(), 1u);
  EXPECT_EQ(beaten[0].setting->setting, "time=1e-05");
  EXPECT_EQ(beaten[0].by->setting, "tolerance=1");
  EXPECT_EQ(beatenOf(study, 0.0).size(), 2u);
}

} // namespace
} // namespace pcl_bsh::accuracy
