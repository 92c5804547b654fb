// SPDX-License-Identifier: BSD-3-Clause
// The drawings of the page of clashes say what its numbers say.
#include "drawing.h"

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/text/number_text.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <optional>

namespace pcl_bsh::io {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

constexpr double kClearance = 0.3;

/// A point that comes near to a row of points a quarter apart.
class ClashDrawings : public testing::Test {
protected:
  /// @param stops where along the row the point is at each pose, and how far off
  std::string page(std::size_t count, const std::vector<std::array<double, 2>>& stops, double radius = 0.0)
  {
    for (std::size_t i = 0; i < count; ++i)
      for (const double coordinate : {0.25 * static_cast<double>(i), 0.0, 0.0}) row.push_back(coordinate);
    for (const auto& [x, y] : stops) poses.emplace_back(Eigen::Translation3d(x, y, 0));
    scan = viewOf(row.data(), count);
    model = shape.value_or(viewOf(probe.data(), 1));
    radii.assign(count, static_cast<float>(radius));
    if (radius > 0) scan.radii = radii.data();
    TrajectoryRequest request;
    request.clearance = kClearance;
    request.distances = request.first_poses = request.closest_poses = request.pose_summaries = true;
    found = collideAlong({SphereHierarchy(scan)}, SphereHierarchy(model), poses, request);
    ClashQuestion question;
    question.clearance = kClearance;
    ClashReport report{.question = question,
                       .cluster_distance = 0.5,
                       .clashes = findClashes(scan, found, 0.5),
                       .scan = scan,
                       .model = model,
                       .poses = poses,
                       .found = found,
                       .survey = {poses, extentOf(scan)}};
    return clashPage(report);
  }

  std::vector<double> row;
  std::vector<float> radii;
  std::array<double, 3> probe = {0, 0, 0};
  PointsView scan, model;
  std::optional<PointsView> shape; ///< of the model, in place of a point
  std::vector<Eigen::Isometry3d> poses;
  TrajectoryResult found;
};

/// Deep red at 0, pale yellow at the clearance; whole numbers are cut.
void expectColour(const std::string& text, double distance)
{
  const double share = std::clamp(distance / kClearance, 0.0, 1.0);
  EXPECT_THAT(colourOf(text), Pointwise(DoubleNear(1.01), {150 + 95 * share, 10 + 180 * share, 40 + 26 * share}))
      << distance;
}

std::vector<double> textsOf(const std::string& drawing)
{
  std::vector<double> numbers;
  for (const Tag& text : tagsOf(drawing, "text")) {
    const std::size_t digit = text.text.find_first_of("-0123456789");
    if (digit != std::string::npos) numbers.push_back(std::strtod(text.text.c_str() + digit, nullptr));
  }
  return numbers;
}

TEST_F(ClashDrawings, BarsHangToTheSmallestDistanceOfThePose)
{
  const std::string path =
      drawingOf(page(41, {{2, 0.2}, {4, 5}, {6, 5}, {8, 0.1}, {8.25, 0.05}}), "smallest distance along the path");
  const std::vector<Tag> bars = with(tagsOf(path, "rect"), "class", "");
  ASSERT_EQ(bars.size(), 3u);
  const std::array<std::array<double, 2>, 3> expected = {{{0, 0.2}, {3, 0.1}, {4, 0.05}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [pose, distance] = expected[i];
    EXPECT_NEAR(bars[i]["x"], 54 + pose * 1010 / 5, 1e-3);
    EXPECT_NEAR(bars[i]["width"], 1010.0 / 5, 1e-3);
    EXPECT_NEAR(bars[i]["height"], 130 * (1 - distance / kClearance), 1e-3);
    expectColour(bars[i].of("fill"), distance);
  }
  EXPECT_THAT(textsOf(path), ElementsAre(0.3, 0, 0, 4)) << "the clearance, the end of the scale, first and last pose";
}

TEST_F(ClashDrawings, FewBarsOfManyPoses)
{
  std::vector<std::array<double, 2>> stops(2500, {0, 9});
  stops[7] = {2, 0.2};
  stops[9] = {2, 0.1};
  stops[2499] = {2, 0.29999};
  const std::string path = drawingOf(page(41, stops), "smallest distance along the path");
  const std::vector<Tag> bars = with(tagsOf(path, "rect"), "class", "");
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_NEAR(bars[0]["x"], 54 + 3 * 1.01, 1e-3) << "poses 7, 8 and 9";
  EXPECT_NEAR(bars[0]["height"], 130 * 2.0 / 3, 1e-3);
  EXPECT_NEAR(bars[1]["x"], 54 + 999 * 1.01, 1e-3);
  EXPECT_NEAR(bars[1]["width"], 1.01, 1e-3);
  EXPECT_EQ(bars[1]["height"], 2) << "to be seen";
}

TEST_F(ClashDrawings, ScaleEndsBelowZeroWhereRadiiOverlap)
{
  const std::string drawn = page(41, {{2, 0.2}, {4, 5}}, 0.5);
  const std::string path = drawingOf(drawn, "smallest distance along the path");
  const std::vector<Tag> bars = with(tagsOf(path, "rect"), "class", "");
  ASSERT_EQ(bars.size(), 1u);
  EXPECT_NEAR(bars[0]["height"], 130, 1e-3);
  expectColour(bars[0].of("fill"), -0.3);
  EXPECT_THAT(textsOf(path), ElementsAre(0.3, -0.3, 0, 1));
  const std::string approach = drawingOf(drawn, "closest approaches along the path");
  EXPECT_NEAR(with(tagsOf(approach, "line"), "class", "limit").at(0)["y1"], 18, 1e-3);
  EXPECT_NEAR(with(tagsOf(approach, "circle"), "class", "closest").at(0)["cy"], 242, 1e-3);
  EXPECT_THAT(textsOf(approach), ElementsAre(0.3, -0.3, 0));
}

TEST_F(ClashDrawings, OnePoseHasNoPath)
{
  EXPECT_EQ(drawingOf(page(41, {{2, 0.2}}), "smallest distance along the path"), "");
}

TEST_F(ClashDrawings, FromAbovePointsLieAsInTheCloud)
{
  const std::string drawn = page(41, {{2, 0.2}, {8, 0.1}, {8.25, 0.05}});
  const std::string above = drawingOf(drawn, "the clash from above");
  // A box from 7.75 to 8.5 with the model's point at 0.05, and half a unit more for the clusters' distance.
  const double scale = 508 / 1.25;
  const auto x = [&](double value) { return 260 + scale * (value - 8.125); };
  const auto y = [&](double value) { return 140 - scale * (value - 0.025); };
  const std::vector<Tag> dots = with(tagsOf(above, "circle"), "r", "2");
  ASSERT_EQ(dots.size(), 4u);
  const double nearest[] = {std::hypot(0.25, 0.1), 0.1, 0.05, std::hypot(0.25, 0.05)};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(dots[i]["cx"], x(7.75 + 0.25 * static_cast<double>(i)), 2e-3);
    EXPECT_NEAR(dots[i]["cy"], y(0), 2e-3);
    expectColour(dots[i].of("fill"), nearest[i]);
  }
  const Tag closest = with(tagsOf(above, "circle"), "class", "closest").at(0);
  const Tag model_point = with(tagsOf(above, "circle"), "r", "2.5").at(0);
  const Tag between = with(tagsOf(above, "line"), "class", "closest").at(0);
  EXPECT_NEAR(closest["cx"], x(8.25), 2e-3);
  EXPECT_NEAR(closest["cy"], y(0), 2e-3);
  EXPECT_NEAR(model_point["cx"], x(8.25), 2e-3);
  EXPECT_NEAR(model_point["cy"], y(0.05), 2e-3);
  for (const char* axis : {"x", "y"}) {
    EXPECT_EQ(between[axis + std::string("1")], closest[std::string("c") + axis]);
    EXPECT_EQ(between[axis + std::string("2")], model_point[std::string("c") + axis]);
  }
  const Tag bar = with(tagsOf(above, "path"), "class", "scale").at(0);
  EXPECT_THAT(bar.of("d"), testing::StartsWith("M16 260v4h81.280v-4")) << "0.2, the round length below a fifth";
  const Tag length = tagsOf(above, "text").at(0);
  EXPECT_EQ(length.text, "0.2");
  EXPECT_NEAR(length["x"], 16 + 81.28 + 6, 1e-2);
}

/// The model's path: where its parts are, at the closest pose, and none that are elsewhere.
TEST_F(ClashDrawings, FromAboveTheObstacleIsThere)
{
  const auto outline = [&] {
    const std::string above = drawingOf(page(41, {{2, 0.2}, {8, 0.1}, {8.25, 0.05}}), "the clash from above");
    return with(tagsOf(above, "path"), "class", "obstacle").at(0).of("d");
  };
  const double scale = 508 / 1.25;
  const auto at = [&](double x, double y) {
    const auto text = [](double number) { return numberText(number, std::chars_format::fixed, 3); };
    return text(260 + scale * (x - 8.125)) + ' ' + text(140 - scale * (y - 0.025));
  };
  EXPECT_EQ(outline(), 'M' + at(8.25, 0.05) + "h1v1h-1z");

  row.clear();
  const std::array<std::array<double, 3>, 6> corners = {
      {{0, 0, 0}, {0.5, 1, 0.25}, {-0.5, 1, 0.25}, {0, 0, 3}, {0.5, 1, 3}, {-0.5, 1, 3}}}; // the second is too high
  const std::array<std::uint32_t, 6> triangles = {0, 1, 2, 3, 4, 5};
  TrianglesView surface;
  surface.vertices = viewOf(corners[0].data(), 6);
  surface.corners = triangles.data();
  surface.count = 2;
  shape = viewOf(surface);
  EXPECT_EQ(outline(), 'M' + at(8.25, 0.05) + 'L' + at(8.75, 1.05) + 'L' + at(7.75, 1.05) + 'z');
}

TEST_F(ClashDrawings, AtMostSoMuchOfTheObstacle)
{
  std::vector<double> crowd;
  for (int i = 0; i < 1000; ++i) crowd.insert(crowd.end(), {0.0002 * i, 0, 0});
  shape = viewOf(crowd.data(), 1000);
  const std::string above = drawingOf(page(1, {{0, 0.1}}), "the clash from above");
  const std::string path = with(tagsOf(above, "path"), "class", "obstacle").at(0).of("d");
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 300);
}

TEST_F(ClashDrawings, ApproachesLieAtTheirPoses)
{
  const std::string drawn = page(41, {{2, 0.2}, {8, 0.1}, {8.25, 0.05}});
  const std::string approach = drawingOf(drawn, "closest approaches along the path");
  const auto y = [](double distance) { return 242 - 224 * distance / kClearance; };
  const std::vector<Tag> dots = with(tagsOf(approach, "circle"), "r", "2");
  ASSERT_EQ(dots.size(), 4u);
  const double distance[] = {std::hypot(0.25, 0.1), 0.1, 0.05, std::hypot(0.25, 0.05)};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(dots[i]["cx"], i < 2 ? 60 : 504, 1e-3) << "the first and the last pose of the clash";
    EXPECT_NEAR(dots[i]["cy"], y(distance[i]), 1e-3);
  }
  const Tag closest = with(tagsOf(approach, "circle"), "class", "closest").at(0);
  EXPECT_NEAR(closest["cx"], 504, 1e-3);
  EXPECT_NEAR(closest["cy"], y(0.05), 1e-3);
  const Tag limit = with(tagsOf(approach, "line"), "class", "limit").at(0);
  EXPECT_EQ(limit["y1"], 18);
  EXPECT_EQ(limit["y2"], 18);
  const std::vector<Tag> texts = tagsOf(approach, "text");
  EXPECT_EQ(texts.at(0)["y"], 22);
  EXPECT_EQ(texts.at(1)["y"], 244);
  EXPECT_THAT(textsOf(approach), ElementsAre(0.3, 0, 1, 2));

  const std::string other = drawingOf(drawn, "closest approaches along the path", 1); // at one pose alone
  EXPECT_THAT(textsOf(other), ElementsAre(0.3, 0, 0));
  EXPECT_EQ(with(tagsOf(other, "circle"), "class", "closest").at(0)["cx"], 282);
}

/// Some of many points are drawn, evenly picked.
TEST_F(ClashDrawings, AtMostSoManyDots)
{
  std::vector<std::array<double, 2>> stops;
  for (int i = 0; i < 1500; ++i) stops.push_back({0.25 * i, 0.001});
  const std::string drawn = page(1500, stops);
  const std::vector<Tag> dots = with(tagsOf(drawingOf(drawn, "the clash from above"), "circle"), "r", "2");
  ASSERT_EQ(dots.size(), 500u);
  for (std::size_t i = 1; i < dots.size(); ++i)
    EXPECT_NEAR(dots[i]["cx"] - dots[i - 1]["cx"], dots[1]["cx"] - dots[0]["cx"], 3e-3);
  EXPECT_GT(dots.back()["cx"] - dots.front()["cx"], 400) << "of all of them";
  const std::vector<Tag> close =
      with(tagsOf(drawingOf(drawn, "closest approaches along the path"), "circle"), "r", "2");
  EXPECT_EQ(close.size(), 500u);
}

} // namespace
} // namespace pcl_bsh::io
