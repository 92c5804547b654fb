// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/tracks.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/track/gauge_table.h>

#include "made_lines.h"
#include "support/random_clouds.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

const Envelope box({"box", {{-1.5, 0}, {1.5, 0}, {1.5, 4}, {-1.5, 4}}});

Axis straight(double y, double length = 100)
{
  AxisDescription description;
  description.plan = {{length, 0, 0, AxisStart{0, y, 0}}};
  return Axis(description);
}

GaugedTracks gaugedAt(const std::vector<Point3>& points, const std::vector<Track>& tracks, unsigned threads = 1)
{
  return gauge(viewOf(points[0].data(), points.size()), tracks, {{}, threads});
}

TEST(GaugedTracks, EachIsTheAnswerOfItsTrackAlone)
{
  AxisDescription left, right;
  left.plan = test::curve({500000, 4000000, 0.4}, 150);
  right.plan = test::curve({500000 + 4 * std::sin(0.4), 4000000 - 4 * std::cos(0.4), 0.4}, 146);
  const Envelope late({"late", {{-2, 0}, {2, 0}, {2, 5}, {-2, 5}}, {{150, 260}}});
  const std::vector<Track> tracks = {{"left", Axis(left), {box, late}}, {"right", Axis(right), {late}}};
  test::Random random(11);
  std::vector<Point3> points;
  for (int i = 0; i < 4000; ++i) {
    const AxisFrame frame = tracks[0].axis.frame(random.uniform(0, tracks[0].axis.length()));
    const double offset = random.uniform(-14, 18), height = random.uniform(-1, 7), ahead = random.uniform(-40, 40);
    Point3 p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = frame.origin[k] + ahead * frame.along[k] + offset * frame.right[k] + height * frame.up[k];
    points.push_back(p);
  }
  points[7][2] = std::numeric_limits<double>::quiet_NaN();
  const GaugedTracks found = gaugedAt(points, tracks);
  ASSERT_EQ(found.each.size(), 2u);
  std::array<std::size_t, 3> told{}; // at none, left, right
  std::array<std::size_t, 6> counts{};
  for (std::size_t t = 0; t < 2; ++t) {
    const GaugedPoints alone = gauge(viewOf(points[0].data(), points.size()), tracks[t].axis, tracks[t].envelopes, {});
    EXPECT_EQ(found.each[t].state, alone.state);
    EXPECT_EQ(found.each[t].envelope, alone.envelope);
    EXPECT_EQ(found.each[t].counts, alone.counts);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_GE(found.track[i], -1);
    ++told[static_cast<std::size_t>(found.track[i] + 1)];
    ++counts[static_cast<std::size_t>(found.told.state[i])];
    double least = std::numeric_limits<double>::quiet_NaN();
    for (const GaugedPoints& alone : found.each) least = std::fmin(least, alone.clearance[i]);
    if (std::isnan(least))
      EXPECT_TRUE(std::isnan(found.told.clearance[i]));
    else
      EXPECT_EQ(found.told.clearance[i], least);
    if (found.track[i] < 0) {
      for (const GaugedPoints& alone : found.each) EXPECT_FALSE(hasPlace(alone.state[i]));
      continue;
    }
    const GaugedPoints& of = found.each[static_cast<std::size_t>(found.track[i])];
    EXPECT_EQ(found.told.state[i], of.state[i]);
    EXPECT_EQ(found.told.place[i].distance, of.place[i].distance);
    EXPECT_EQ(found.told.place[i].offset, of.place[i].offset);
    EXPECT_EQ(found.told.envelope[i], of.envelope[i]);
  }
  for (const std::size_t count : told) EXPECT_GT(count, 100u);
  EXPECT_EQ(found.told.counts, counts);
  EXPECT_EQ(gaugedAt(points, tracks, 3).track, found.track);
}

TEST(GaugedTracks, APointIsToldWithOneOfThem)
{
  const Envelope elsewhere({"elsewhere", {{-1, 0}, {1, 0}, {1, 4}}, {{500, 600}}});
  const std::vector<Track> tracks = {{"left", straight(4), {box}},
                                     {"right", straight(0, 60), {box}},
                                     {"siding", straight(-4), {elsewhere}},
                                     {"short", straight(1, 20), {box}}};
  const GaugedTracks found = gaugedAt({{30, 2.5, 1},  // nearer to left
                                       {30, 2, 1},    // as near to left and to right
                                       {10, 0.9, 9},  // as near to both tops: nearer to the axis of short
                                       {80, -5, 1},   // the siding is nearer, and nothing counts there
                                       {80, -13, 1}}, // at the siding alone
                                      tracks);
  EXPECT_THAT(found.track, testing::ElementsAre(0, 0, 3, 0, 2));
  EXPECT_EQ(found.told.clearance[0], 0);
  EXPECT_EQ(found.told.clearance[3], 7.5);
  EXPECT_EQ(found.told.envelope[4], -1);
  EXPECT_EQ(found.told.place[4].offset, 9);
  EXPECT_THROW(gaugedAt({{0, 0, 0}}, {}), InvalidInput);
  EXPECT_THROW(gaugedAt({{0, 0, 0}}, {{"bare", straight(0), {}}}), InvalidInput);
}

TEST(GaugedTracks, APointWithoutAPlaceIsToldByTheNearestReason)
{
  const std::vector<Track> tracks = {{"far", straight(50), {box}}, {"right", straight(0, 60), {box}}};
  const GaugedTracks found = gaugedAt({{70, 0, 1}, {-1, 0, 1}, {30, 25, 1}}, tracks);
  EXPECT_THAT(found.track, testing::Each(-1));
  EXPECT_THAT(found.told.state, testing::ElementsAre(PlaceState::behind, PlaceState::before, PlaceState::too_far));
  EXPECT_THAT(found.told.counts, testing::ElementsAre(0, 0, 1, 1, 1, 0));
}

TEST(GaugedTracks, APointInBothInfringesBoth)
{
  const std::vector<Track> tracks = {{"left", straight(2), {box}}, {"right", straight(0), {box}}};
  const std::vector<Point3> points = {{30, 0.75, 1}, {30.2, 1.25, 1}, {30.4, 3, 1}};
  const GaugedTracks found = gaugedAt(points, tracks);
  std::vector<Infringing> list;
  for (std::uint32_t track = 0; track < 2; ++track)
    addInfringing(viewOf(points[0].data(), points.size()), found.each[track], 0.0, 0, list, track);
  ASSERT_EQ(list.size(), 5u);
  const std::vector<Infringement> both = infringementsOf(list, 2.0);
  ASSERT_EQ(both.size(), 2u) << "points of two tracks never lie together";
  EXPECT_EQ(both[0].worst.track, 1u) << "0.75 deep, as 0.5 at left";
  EXPECT_EQ(both[0].members.size(), 2u);
  EXPECT_EQ(both[1].worst.track, 0u);
  EXPECT_EQ(both[1].members.size(), 3u);
  EXPECT_EQ(both[1].worst.record, 1u);
}

} // namespace
} // namespace pcl_bsh
