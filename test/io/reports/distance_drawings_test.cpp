// SPDX-License-Identifier: BSD-3-Clause
// The drawings of the page of distances say what its numbers say.
#include "drawing.h"

#include <pcl_bsh/io/reports/distance_report.h>

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace pcl_bsh::io {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Not;
using testing::Pointwise;

/// Points of a plane, and others above some of them.
class DistanceDrawings : public testing::Test {
protected:
  void add(double x, double y, double height)
  {
    low.insert(low.end(), {x, y, 0});
    high.insert(high.end(), {x, y, height});
  }

  /// Ten by ten, 4 apart: the first 60 at 0.1, the next 30 at 0.3, the last ten at 0.5.
  void addThreeSteps()
  {
    for (int i = 0; i < 100; ++i) add(4.0 * (i % 10), 4.0 * (i / 10), i < 60 ? 0.1 : i < 90 ? 0.3 : 0.5);
  }

  std::string page() const
  {
    const SphereHierarchy a(viewOf(high.data(), high.size() / 3)), b(viewOf(low.data(), low.size() / 3));
    const SymmetricDistances found = symmetricDistances({a}, {b}, question.request);
    return distancePage(reportOf(question, {a}, {b}, found));
  }

  std::vector<double> low, high;
  DistanceQuestion question;
};

/// The colour at a share of the scale's end: pale grey, orange, red, deep red.
void expectShade(const std::string& text, double share)
{
  const double stops[4][3] = {{176, 190, 205}, {244, 196, 80}, {224, 98, 36}, {140, 8, 38}};
  const double at = std::min(std::max(share, 0.0), 1.0) * 3;
  const int from = std::min(static_cast<int>(at), 2);
  std::vector<double> colour;
  for (int k = 0; k < 3; ++k) colour.push_back(stops[from][k] + (at - from) * (stops[from + 1][k] - stops[from][k]));
  EXPECT_THAT(colourOf(text), Pointwise(DoubleNear(1.01), colour)) << share;
}

TEST_F(DistanceDrawings, BarsAreAsHighAsTheirIntervalsAreFull)
{
  addThreeSteps();
  const std::string histogram = drawingOf(page(), "histogram of distances");
  const std::vector<Tag> bars = with(tagsOf(histogram, "rect"), "class", "");
  ASSERT_EQ(bars.size(), 3u);
  const std::vector<Tag> texts = tagsOf(histogram, "text");
  const double end = std::strtod(texts.at(7).text.c_str(), nullptr);
  EXPECT_NEAR(end, 0.5, 0.01);
  const double counts[] = {60, 30, 10}, distances[] = {0.1, 0.3, 0.5};
  for (std::size_t i = 0; i < 3; ++i) {
    const double height = 140 * counts[i] / 60, width = bars[i]["width"] + 1;
    EXPECT_NEAR(bars[i]["height"], height, 1e-3);
    EXPECT_NEAR(bars[i]["y"], 12 + 140 - height, 1e-3);
    EXPECT_NEAR(bars[i]["x"] + 0.5 * width, 70 + 994 * distances[i] / end, 0.51 * width + 1e-3);
    expectShade(bars[i].of("fill"), (bars[i]["x"] + 0.5 * width - 70) / 994);
  }
  EXPECT_EQ(texts.at(0).text, "60");
  for (int i = 0; i <= 5; ++i) {
    const Tag& tick = texts.at(2 + static_cast<std::size_t>(i));
    EXPECT_NEAR(tick["x"], 70 + 994 * i / 5.0, 1e-3);
    EXPECT_NEAR(std::strtod(tick.text.c_str(), nullptr), end * i / 5, 1e-3 * end);
    EXPECT_EQ(tick.of("text-anchor"), i == 0 ? "start" : i == 5 ? "end" : "middle");
  }
}

/// A few points are drawn one unit high, to be seen.
TEST_F(DistanceDrawings, NoBarIsTooLowToBeSeen)
{
  for (int i = 0; i < 1000; ++i) add(4.0 * i, 0, i < 40 ? 0.5 : i == 40 ? 0.3 : 0.1);
  const std::vector<Tag> bars = with(tagsOf(drawingOf(page(), "histogram of distances"), "rect"), "class", "");
  ASSERT_EQ(bars.size(), 3u);
  EXPECT_EQ(bars[1]["height"], 1);
  EXPECT_EQ(bars[1]["y"], 151);
}

/// Where each `M` begins a dot.
std::vector<std::pair<double, double>> dotsOf(const Tag& path)
{
  std::vector<std::pair<double, double>> dots;
  const std::string d = path.of("d");
  for (std::size_t at = d.find('M'); at != std::string::npos; at = d.find('M', at + 1)) {
    char* second = nullptr;
    const double x = std::strtod(&d[at + 1], &second);
    dots.emplace_back(x, std::strtod(second, nullptr));
  }
  return dots;
}

TEST_F(DistanceDrawings, FromAbovePointsLieAsInTheCloud)
{
  addThreeSteps();
  question.beyond = 0.4;
  const std::string above = drawingOf(page(), "the cloud from above, by distance");
  const std::vector<Tag> paths = with(tagsOf(above, "path"), "class", "");
  ASSERT_EQ(paths.size(), 3u);
  const double scale = 458 / (36 * 1.04);
  const auto x = [&](double value) { return 540 + scale * (value - 18); };
  const auto y = [&](double value) { return 235 - scale * (value - 18); };
  std::size_t next = 0;
  for (const auto& [path, share] : {std::pair(0, 0.2), std::pair(1, 0.6), std::pair(2, 1.0)}) {
    expectShade(paths[static_cast<std::size_t>(path)].of("fill"), std::floor(share * 23 + 1e-6) / 23);
    for (const auto& [at_x, at_y] : dotsOf(paths[static_cast<std::size_t>(path)])) {
      EXPECT_NEAR(at_x, x(4.0 * static_cast<double>(next % 10)), 0.06);
      EXPECT_NEAR(at_y, y(4.0 * static_cast<double>(next / 10)), 0.06);
      ++next;
    }
  }
  EXPECT_EQ(next, 100u);
  EXPECT_THAT(above, HasSubstr("h2v2h-2z"));
  const std::vector<Tag> legend = with(tagsOf(above, "rect"), "class", "");
  ASSERT_EQ(legend.size(), 24u);
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_NEAR(legend[i]["x"], 570 + 12.5 * static_cast<double>(i), 1e-3);
    expectShade(legend[i].of("fill"), static_cast<double>(i) / 23);
  }
  const std::vector<Tag> rings = with(tagsOf(above, "circle"), "class", "closest"), texts = tagsOf(above, "text");
  ASSERT_EQ(rings.size(), 1u) << "of the last row's points, which are one place";
  EXPECT_NEAR(rings[0]["cx"], x(0), 2e-3);
  EXPECT_NEAR(rings[0]["cy"], y(36), 2e-3);
  EXPECT_EQ(texts.at(1).text, "10") << "a round length below a fifth of the drawing's width";
  EXPECT_NEAR(texts.at(1)["x"], 24 + 10 * scale, 1e-2);
}

TEST_F(DistanceDrawings, WhatHasNoDistanceIsDrawnAsTheFarthest)
{
  addThreeSteps();
  question.request.max_distance = 0.2;
  const std::vector<Tag> paths =
      with(tagsOf(drawingOf(page(), "the cloud from above, by distance"), "path"), "class", "");
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(dotsOf(paths[0]).size(), 100u);
  expectShade(paths[0].of("fill"), 1);
  EXPECT_THAT(page(), HasSubstr("greatest distance asked for"));
  EXPECT_THAT(page(), HasSubstr("40 points have no distance</text>"));
  EXPECT_THAT(page(), HasSubstr("<tr><td>points with a distance</td><td></td><td>60</td><td>60</td></tr>"));
  EXPECT_THAT(page(), Not(HasSubstr("more there are")));
}

TEST_F(DistanceDrawings, OnePointLiesInTheMiddle)
{
  add(7, 8, 0.25);
  const std::string whole = page();
  EXPECT_THAT(drawingOf(whole, "the cloud from above, by distance"), HasSubstr("M540.0 235.0h2"));
  EXPECT_EQ(tagsOf(drawingOf(whole, "the cloud from above, by distance"), "text").at(0).text, "0.2") << "of 1 by 1";
  EXPECT_THAT(whole, Not(HasSubstr("nan")));
  EXPECT_THAT(whole, Not(HasSubstr("inf")));
}

TEST_F(DistanceDrawings, SomeOfManyPointsAreShown)
{
  for (int i = 0; i < 9000; ++i) add(0.5 * i, 0, 0.125);
  const std::string above = drawingOf(page(), "the cloud from above, by distance");
  EXPECT_THAT(page(), HasSubstr("From above, 6000 of 9000 points;"));
  const auto dots = dotsOf(with(tagsOf(above, "path"), "class", "").at(0));
  ASSERT_EQ(dots.size(), 6000u);
  EXPECT_LT(dots.front().first, 30) << "evenly, from one end to the other";
  EXPECT_GT(dots.back().first, 1050);
}

TEST_F(DistanceDrawings, APlaceIsAsLargeAsItsLongestSide)
{
  for (int i = 0; i < 400; ++i) add(0.5 * i, 0, i < 5 ? 9.0 : 0.125);
  question.beyond = 1;
  const std::string whole = page(), table = whole.substr(whole.find("<table><tr><th>place"));
  EXPECT_TRUE(
      testing::Value(table, HasSubstr("<tr><td>1</td><td>0.000, 0.000, 9.000</td><td>9</td><td>5</td><td>2</td>")));
}

/// Twenty of 23 places are in the table, and ten in the drawing.
TEST_F(DistanceDrawings, TwentyPlacesAreListed)
{
  for (int i = 0; i < 400; ++i) add(4.0 * i, 0, i % 10 == 0 && i < 230 ? 9.0 - 0.0125 * i : 0.125);
  question.beyond = 1;
  const std::string whole = page(), table = whole.substr(whole.find("<table><tr><th>place"));
  EXPECT_TRUE(testing::Value(table, HasSubstr("<tr><td>1</td><td>0.000, 0.000, 9.000</td><td>9</td><td>1</td><td>0</td>"
                                              "<td>0</td><td>0</td></tr>")));
  EXPECT_TRUE(testing::Value(table, HasSubstr("<tr><td>20</td><td>760.000, 0.000, 6.625</td>")));
  EXPECT_FALSE(testing::Value(table, HasSubstr("<tr><td>21</td><td>800.000, 0.000, 6.5")));
  EXPECT_TRUE(testing::Value(table, HasSubstr("farther than 1. The farthest are listed; 3 more there are.</p>")));

  const std::string above = drawingOf(whole, "the cloud from above, by distance");
  const std::vector<Tag> rings = with(tagsOf(above, "circle"), "class", "closest"), texts = tagsOf(above, "text");
  ASSERT_EQ(rings.size(), 10u);
  const double scale = 1068 / (1596 * 1.04);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(rings[i]["cx"], 540 + scale * (40.0 * static_cast<double>(i) - 798), 2e-3);
    EXPECT_NEAR(texts.at(i)["x"], rings[i]["cx"] + 12, 2e-3);
    EXPECT_NEAR(texts.at(i)["y"], rings[i]["cy"] + 4, 2e-3);
    EXPECT_EQ(texts.at(i).text, std::to_string(i + 1));
  }
}

} // namespace
} // namespace pcl_bsh::io
