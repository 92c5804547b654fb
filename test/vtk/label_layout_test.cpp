// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/label_layout.h>

#include <gtest/gtest.h>

#include <random>

namespace pcl_bsh::vtk {
namespace {

bool overlap(const PixelBox& a, const PixelBox& b)
{
  return a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;
}

LabelSpace emptySpace()
{
  LabelSpace space;
  space.frame = {0, 0, 400, 300};
  return space;
}

TEST(LabelLayout, PutsALabelBesideItsMark)
{
  const auto places = placeLabels({{{200, 150}, 60, 20}}, emptySpace());
  ASSERT_TRUE(places[0]);
  EXPECT_GT(places[0]->left, 200.0);
  EXPECT_NEAR(places[0]->right - places[0]->left, 60.0, 1e-9);
  EXPECT_NEAR(places[0]->top - places[0]->bottom, 20.0, 1e-9);
}

TEST(LabelLayout, TurnsToTheOtherSideAtTheEdge)
{
  const auto places = placeLabels({{{395, 150}, 60, 20}}, emptySpace());
  ASSERT_TRUE(places[0]);
  EXPECT_LT(places[0]->right, 395.0);
}

TEST(LabelLayout, MayBeHalfAGapFromWhatIsTaken)
{
  const PixelBox first = *placeLabels({{{200, 150}, 60, 20}}, emptySpace())[0];
  const double gap = 0.5 * emptySpace().gap, left = first.left - gap, right = first.right + gap,
               bottom = first.bottom - gap, top = first.top + gap;
  for (const PixelBox& beside : {PixelBox{left, top, right, top + 9}, PixelBox{left, bottom - 9, right, bottom},
                                 PixelBox{right, bottom, right + 9, top}, PixelBox{left - 9, bottom, left, top}}) {
    LabelSpace space = emptySpace();
    space.taken = {beside};
    const PixelBox now = *placeLabels({{{200, 150}, 60, 20}}, space)[0];
    EXPECT_EQ(now.left, first.left);
    EXPECT_EQ(now.bottom, first.bottom);
  }
}

TEST(LabelLayout, StandsAsideOfALineThroughTheMark)
{
  LabelSpace space = emptySpace();
  space.taken = {{192, 142, 208, 158}}; // the mark itself
  space.lines = {{{0, 150}, {400, 150}}, {{200, 0}, {200, 300}}};
  const auto places = placeLabels({{{200, 150}, 60, 20}}, space);
  ASSERT_TRUE(places[0]);
  EXPECT_GT(places[0]->left, 208.0);
  EXPECT_GT(places[0]->bottom, 158.0);
}

/// A line may run along an edge of the room that a label has, and leads it elsewhere from within.
TEST(LabelLayout, ALineAlongTheEdgeLeavesThePlaceAndOneWithinTakesIt)
{
  const PixelBox first = *placeLabels({{{200, 150}, 60, 20}}, emptySpace())[0];
  const double gap = 0.5 * emptySpace().gap, left = first.left - gap, right = first.right + gap,
               bottom = first.bottom - gap, top = first.top + gap;
  const auto stays = [&](const PixelSegment& line) {
    LabelSpace space = emptySpace();
    space.lines = {line};
    const std::optional<PixelBox> now = placeLabels({{{200, 150}, 60, 20}}, space)[0];
    return now && now->left == first.left && now->bottom == first.bottom;
  };
  for (const double x : {left - 1, left, right, right + 1}) EXPECT_TRUE(stays({{x, 0}, {x, 300}})) << x;
  for (const double y : {bottom - 1, bottom, top, top + 1}) EXPECT_TRUE(stays({{0, y}, {400, y}})) << y;
  for (const double x : {left + 1, right - 1}) EXPECT_FALSE(stays({{x, 0}, {x, 300}})) << x;
  for (const double y : {bottom + 1, top - 1}) EXPECT_FALSE(stays({{0, y}, {400, y}})) << y;
}

TEST(LabelLayout, NeverCoversLabelsMarksOrLines)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(10, 390), y(10, 290);
  std::size_t placed = 0;
  for (int round = 0; round < 50; ++round) {
    LabelSpace space = emptySpace();
    std::vector<Label> labels;
    for (int i = 0; i < 15; ++i) {
      labels.push_back({{x(random), y(random)}, 70, 20});
      const auto& at = labels.back().at;
      space.taken.push_back({at[0] - 8, at[1] - 8, at[0] + 8, at[1] + 8});
    }
    for (std::size_t i = 1; i < 5; ++i) space.lines.push_back({labels[i - 1].at, labels[i].at});
    const auto places = placeLabels(labels, space);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!places[i]) continue;
      ++placed;
      EXPECT_GE(places[i]->left, 0.0);
      EXPECT_LE(places[i]->right, 400.0);
      for (const PixelBox& mark : space.taken) EXPECT_FALSE(overlap(*places[i], mark));
      for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(places[k] && overlap(*places[i], *places[k]));
      for (const PixelSegment& line : space.lines) {
        for (double t = 0.0; t <= 1.0; t += 1e-3) {
          const double u = line.from[0] + t * (line.to[0] - line.from[0]),
                       v = line.from[1] + t * (line.to[1] - line.from[1]);
          ASSERT_FALSE(overlap(*places[i], {u, v, u, v}));
        }
      }
    }
  }
  EXPECT_GT(placed, 300u);
}

TEST(LabelLayout, LeavesOutWhatHasNoPlaceAndKeepsTheEarlier)
{
  LabelSpace space = emptySpace();
  space.frame = {0, 0, 100, 30};
  const auto places = placeLabels({{{10, 15}, 70, 20}, {{10, 15}, 70, 20}}, space);
  EXPECT_TRUE(places[0]);
  EXPECT_FALSE(places[1]);
}

} // namespace
} // namespace pcl_bsh::vtk
