// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/accuracy/picture.h>

#include <gmock/gmock.h>

namespace pcl_bsh::accuracy {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Measurement measured(const std::string& query, const std::string& knob, const std::string& setting, double seconds,
                     double error)
{
  Measurement m;
  m.query = query;
  m.knob = knob;
  m.setting = setting;
  m.seconds = {0.9 * seconds, seconds, 1.2 * seconds};
  m.once = {2 * seconds, 2 * seconds, 3 * seconds};
  m.certified_error = error;
  return m;
}

Measurement peer(const std::string& query, const std::string& knob, const std::string& setting, double seconds,
                 double error)
{
  Measurement m = measured(query, knob, setting, seconds, 0.0);
  m.peer = true;
  m.certified = false;
  m.actual_error = error;
  return m;
}

std::vector<std::string> settingsOf(const std::vector<const Measurement*>& all)
{
  std::vector<std::string> settings;
  for (const Measurement* m : all) settings.push_back(m->setting);
  return settings;
}

Study studied()
{
  Study study;
  study.measurements = {measured("distance", "exact", "exact", 1e-3, 0.0),
                        measured("distance", "level of detail", "level=0", 5e-5, 4.0),
                        measured("distance", "level of detail", "level=1", 9e-5, 0.7),
                        measured("distance", "level of detail", "level=9", 8e-4, 1e-12), // by luck
                        measured("distance", "tolerance", "tolerance=1", 2e-5, 0.8),
                        measured("distance", "tolerance", "tolerance=0.01", 9e-4, 0.01),
                        measured("distance", "budget of tests", "pairs=10000", 2e-3, 0.001), // slower than exact
                        measured("flags", "exact", "exact", 1e-4, 0.0),
                        measured("flags", "level of detail", "level=0", 5e-5, 0.02)};
  study.measurements.push_back(peer("distance", "k-d tree", "epsilon=0", 0.25, 1e-9));
  study.measurements.push_back(peer("distance", "VoxelGrid + k-d tree", "leaf=1", 2e-2, 0.6));
  study.colliding = 10;
  return study;
}

TEST(AccuracyPicture, FrontierHoldsWhatNothingBeatsAndEndsInExact)
{
  EXPECT_THAT(settingsOf(frontier(studied(), "distance", 1e-9)),
              ElementsAre("tolerance=1", "level=1", "tolerance=0.01", "exact"));
  EXPECT_THAT(settingsOf(frontier(studied(), "flags", 0.0)), ElementsAre("level=0", "exact"));
  EXPECT_THAT(frontier({}, "flags", 0.0), IsEmpty());
}

TEST(AccuracyPicture, DrawsOursAtTheGuaranteedAndOthersAtTheMeasuredError)
{
  Subject subject;
  const std::vector<float> xyz(3 * 100);
  subject.a = viewOf(xyz.data(), 100);
  subject.poses.resize(2);
  subject.diameter = 50.0;
  subject.unit = "m";
  const std::vector<vtk::Chart> charts = chartsOf(subject, studied());
  ASSERT_EQ(charts.size(), 2u);
  const vtk::Chart& distance = charts[0];
  ASSERT_EQ(distance.series.size(), 6u); // three, and the same asked once
  EXPECT_TRUE(distance.series[0].joined);
  EXPECT_EQ(distance.series[0].points.front().label, "exact");
  EXPECT_EQ(distance.series[0].points.back().y, 0.8);
  EXPECT_EQ(distance.series[2].points.front().y, 0.6);
  EXPECT_LE(distance.series[1].points.front().y, distance.lowest_y); // rounding of float
  EXPECT_THAT(distance.series[2].points.front().spread, ElementsAre(0.9 * 2e-2, 1.2 * 2e-2));
  EXPECT_TRUE(distance.series[5].faint);
  EXPECT_EQ(distance.series[5].name, "");
  EXPECT_EQ(distance.series[5].points.front().x, 2 * 2e-2);
  EXPECT_EQ(distance.series[5].points.front().y, 0.6);
  ASSERT_EQ(distance.spans.size(), 1u);
  EXPECT_EQ(distance.spans[0].text, "250 x faster");
  EXPECT_EQ(distance.y.ticks.front().text, "1 cm");
  EXPECT_EQ(distance.y.ticks.back().text, "1 m");
  EXPECT_EQ(distance.x.ticks.front().text, "10 \xc2\xb5s");
  EXPECT_EQ(distance.x.ticks.back().text, "1 s");
  // 0.02 of 200 answers are undecided, 10 points collide.
  EXPECT_DOUBLE_EQ(charts[1].series[0].points.back().y, 0.4);
}

} // namespace
} // namespace pcl_bsh::accuracy
