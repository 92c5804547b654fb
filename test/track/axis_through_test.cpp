// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/axis.h>

#include <pcl_bsh/base/invalid_input.h>

#include "made_lines.h"
#include "support/random.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

std::vector<AxisPoint> measuredOf(const std::vector<PlanElement>& plan, double length, double step, double cant = 0.001)
{
  std::vector<AxisPoint> points;
  for (double at = 0; at <= length; at += step) {
    const test::TrueFrame truth = test::trueFrameAt(plan, at);
    points.push_back({1000 + at, {static_cast<double>(truth.x), static_cast<double>(truth.y), 0.01 * at}, cant * at});
  }
  return points;
}

TEST(AxisThrough, PointsOfACircleGiveTheCircle)
{
  const std::vector<PlanElement> plan = {{190, 0.01, 0.01, AxisStart{500000, 4000000, 1}}};
  const Axis axis = Axis::through(measuredOf(plan, 190, 5));
  EXPECT_NEAR(axis.length(), 190, 1e-8);
  EXPECT_NEAR(axis.smallestRadius(), 100, 1e-5) << "points have nanometres";
  for (double at = 1; at < 190; at += 13.7) {
    const test::TrueFrame truth = test::trueFrameAt(plan, at);
    const Point3 point = {static_cast<double>(truth.x + 3 * std::sin(truth.heading)),
                          static_cast<double>(truth.y - 3 * std::cos(truth.heading)), 7};
    const AxisPlaces found = axis.nearest(point, {});
    EXPECT_NEAR(axis.chainage(found.best.distance), 1000 + at, 4e-9);
    EXPECT_NEAR(axis.cant(found.best.distance), 0.001 * at, 1e-11);
  }
  EXPECT_NEAR(axis.fit().deviation, 25 / 800.0, 2e-4) << "a chord's height";
  EXPECT_LT(axis.fit().stretch, 1e-9);
}

TEST(AxisThrough, PointsOfAClothoidGiveALineNearIt)
{
  const std::vector<PlanElement> plan = test::curve({0, 0, 0});
  const Axis axis = Axis::through(measuredOf(plan, 400, 5, 0));
  for (double at = 10; at < 390; at += 7.1) {
    const AxisPlaces found = axis.nearest(
        {static_cast<double>(test::trueFrameAt(plan, at).x), static_cast<double>(test::trueFrameAt(plan, at).y), 1},
        {});
    EXPECT_NEAR(found.best.offset, 0, 3e-4) << at;
    EXPECT_NEAR(axis.chainage(found.best.distance), 1000 + at, 1e-5) << at;
  }
}

TEST(AxisThrough, PointsKeepTheirChainages)
{
  const Axis axis = Axis::through({{10, {0, 0, 0}}, {20.5, {10, 0, 0}}, {30, {20, 0, 0}}});
  EXPECT_DOUBLE_EQ(axis.chainage(10), 20.5);
  EXPECT_DOUBLE_EQ(axis.chainage(5), 15.25);
  EXPECT_NEAR(axis.fit().stretch, 1 / 19.0, 1e-12);
}

TEST(AxisThrough, NoPlaceIsBeyondItsEnds)
{
  test::Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const auto across = [&] { return random.uniform(0, 1); };
    const Axis axis = Axis::through({{0, {0, 0, 0}}, {10, {10, across(), 0}}, {20, {20, across(), 0}}});
    for (const double end : {0.0, axis.length()}) {
      const AxisPlaces found = axis.nearest(axis.frame(end).origin, {1, 1, 1});
      EXPECT_GE(found.best.distance, 0.0);
      EXPECT_LE(found.best.distance, axis.length()) << "the sum of its parts is rounded";
    }
  }
}

TEST(AxisThrough, RefusesWhatIsNoLine)
{
  const auto refusal = [](const std::vector<AxisPoint>& points) -> std::string {
    try {
      Axis::through(points);
      return {};
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
  };
  using testing::HasSubstr;
  EXPECT_THAT(refusal({{0, {0, 0, 0}}}), HasSubstr("has 1 points"));
  EXPECT_THAT(refusal({{5, {0, 0, 0}}, {4, {1, 0, 0}}}), HasSubstr("point 1: its chainage 4 does not exceed"));
  EXPECT_THAT(refusal({{5, {0, 0, 0}}, {6, {0, 0, 1}}}), HasSubstr("lies where the one before lies"));
  EXPECT_THAT(refusal({{5, {0, 0, 0}}, {6, {1, 0, 0}}, {7, {1, 1, 0}}}),
              HasSubstr("turns by 1.5708 radians at chainage 6"));
  EXPECT_THAT(refusal({{5, {0, 0, 0}}, {6, {1, 0, 0}}, {7, {0.5, 0, 0}}}), HasSubstr("turns by 3.14159"));
  EXPECT_THAT(refusal({{5, {0, 0, 0}}, {6, {1, std::nan(""), 0}}}), HasSubstr("not finite"));
}

/// Straights, clothoids and arcs, measured every two metres, and each point off by up to `noise` in plan.
std::vector<AxisPoint> noisyOf(const std::vector<PlanElement>& plan, double length, double step, double noise)
{
  std::vector<AxisPoint> points = measuredOf(plan, length, step, 0);
  test::Random random(1);
  for (AxisPoint& point : points)
    for (std::size_t k = 0; k < 2; ++k) point.at[k] += random.uniform(-noise, noise) / std::sqrt(2.0);
  return points;
}

TEST(AxisFitted, IsWithinItsToleranceAndHasTheRadiiOfTheLine)
{
  const std::vector<PlanElement> plan = test::curve({500000, 4000000, 1});
  double least_radius = std::numeric_limits<double>::infinity();
  for (const PlanElement& element : plan)
    least_radius = std::min(least_radius, 1.0 / std::max(1e-9, std::abs(element.curvature_end)));
  for (const double noise : {0.0, 0.002, 0.01}) {
    const double tolerance = std::max(0.005, 2.0 * noise);
    const std::vector<AxisPoint> points = noisyOf(plan, 400, 2, noise);
    const Axis axis = Axis::fitted(points, tolerance);
    EXPECT_LE(axis.fit().deviation, tolerance) << noise;
    EXPECT_LT(axis.fit().stretch, 0.02) << noise;
    EXPECT_LT(axis.description().plan.size(), points.size() / 4) << noise;
    EXPECT_NEAR(axis.smallestRadius(), least_radius, 0.1 * least_radius) << noise;
    for (double at = 1; at < 399; at += 3.3) {
      const test::TrueFrame truth = test::trueFrameAt(plan, at);
      const AxisPlaces found = axis.nearest({static_cast<double>(truth.x), static_cast<double>(truth.y), 4}, {});
      EXPECT_NEAR(found.best.offset, 0, 2.0 * tolerance) << at;
      EXPECT_NEAR(axis.chainage(found.best.distance), 1000 + at, 0.02 + 2 * noise) << at;
    }
    if (noise < 0.01) continue;
    const Axis through = Axis::through(points);
    EXPECT_LT(through.smallestRadius(), 0.5 * least_radius) << "arcs through all points follow their noise";
  }
}

TEST(AxisFitted, OfFewPointsIsThroughThem)
{
  const Axis two = Axis::fitted({{10, {0, 0, 0}}, {20, {10, 0, 1}}}, 0.01);
  EXPECT_DOUBLE_EQ(two.length(), 10);
  EXPECT_DOUBLE_EQ(two.chainage(5), 15);
  const Axis three = Axis::fitted({{10, {0, 0, 0}}, {20, {10, 0.1, 0}}, {30, {20, 0, 0}}}, 0.001);
  EXPECT_LE(three.fit().deviation, 1e-9);
}

/// Neighbours that lie nearer to each other than they err.
TEST(AxisFitted, OfDensePointsKeepsItsOrder)
{
  const std::vector<PlanElement> plan = {{100, 0.002, 0.002, AxisStart{0, 0, 0}}};
  const std::vector<AxisPoint> points = noisyOf(plan, 100, 0.02, 0.01);
  const Axis axis = Axis::fitted(points, 0.03);
  EXPECT_LE(axis.fit().deviation, 0.03);
  EXPECT_NEAR(axis.length(), 100, 0.05);
  EXPECT_NEAR(axis.smallestRadius(), 500, 100);
  for (double at = 1; at < 99; at += 3.3) EXPECT_NEAR(axis.chainage(at), 1000 + at, 0.05);
}

TEST(AxisFitted, RefusesWhatIsNoLine)
{
  const std::vector<AxisPoint> kink = {{5, {0, 0, 0}}, {6, {1, 0, 0}}, {7, {2, 0, 0}}, {8, {2, 1, 0}}, {9, {2, 2, 0}}};
  EXPECT_THROW(Axis::fitted(kink, 0.01), InvalidInput);
  EXPECT_THROW(Axis::fitted({{5, {0, 0, 0}}}, 0.01), InvalidInput);
  try {
    Axis::fitted({{5, {0, 0, 0}}, {6, {1, 0, 0}}, {7, {2, 0, 0}}, {8, {1, 0, 0}}, {9, {0, 0, 0}}}, 0.01);
    FAIL() << "it goes there, and back";
  }
  catch (const InvalidInput& error) {
    EXPECT_EQ(error.index(), 2u);
    EXPECT_STREQ(error.what(), "axis point 2: its two neighbours lie at one place: leave one of the three out");
  }
  for (const double tolerance : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(Axis::fitted({{10, {0, 0, 0}}, {20, {10, 0, 0}}}, tolerance), InvalidInput) << tolerance;
}

} // namespace
} // namespace pcl_bsh
