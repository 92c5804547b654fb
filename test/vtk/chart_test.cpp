// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/vtk/chart.h>

#include <gtest/gtest.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <cmath>
#include <cstdlib>
#include <map>

namespace pcl_bsh::vtk {
namespace {

class ChartPicture : public testing::Test {
protected:
  ChartPicture()
  {
    unsetenv("DISPLAY");
    chart.title = "title";
    chart.x = {"time", {{1e-5, "10"}, {1e-4, "100"}, {1e-3, "1000"}}};
    chart.y = {"error", {{0.01, "1"}, {0.1, "10"}, {1, "100"}}};
    chart.lowest = "exact";
  }

  void draw(const std::vector<Chart>& charts)
  {
    writeChartsPng(charts, 800, 500, folder / "chart.png");
    reader->SetFileName((folder / "chart.png").c_str());
    reader->Modified(); // the file has changed
    reader->Update();
    image = reader->GetOutput();
  }

  /// The middle of all pixels of a colour, and how many there are; from the lower left.
  struct Blot {
    double x = 0.0, y = 0.0;
    std::size_t count = 0;
  };
  Blot blotOf(const std::array<unsigned char, 3>& color) const
  {
    Blot blot;
    const int* const size = image->GetDimensions();
    for (int y = 0; y < size[1]; ++y) {
      for (int x = 0; x < size[0]; ++x) {
        const auto* const c = static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
        if (c[0] != color[0] || c[1] != color[1] || c[2] != color[2]) continue;
        blot.x += x;
        blot.y += y;
        ++blot.count;
      }
    }
    blot.x /= static_cast<double>(blot.count);
    blot.y /= static_cast<double>(blot.count);
    return blot;
  }

  static Series seriesAt(std::size_t color, double x, double y)
  {
    return {"", distinctColor(color), Mark::circle, true, false, false, {{x, y, ""}}};
  }

  files::TemporaryFolder folder;
  Chart chart;
  vtkNew<vtkPNGReader> reader;
  vtkImageData* image = nullptr;
  double left = 0.0, right = 0.0; ///< of the axis, in pixels
};

TEST_F(ChartPicture, PutsPointsByTheLogarithmOfTimeAndError)
{
  chart.series = {seriesAt(0, 1e-5, 1.0), seriesAt(1, 1e-4, 0.1), seriesAt(2, 1e-3, 0.01), seriesAt(3, 1e-4, 0.0)};
  draw({chart});
  EXPECT_EQ(image->GetDimensions()[0], 800);
  EXPECT_EQ(image->GetDimensions()[1], 500);
  const Blot slowless = blotOf(distinctColor(0)), middle = blotOf(distinctColor(1)), slow = blotOf(distinctColor(2)),
             exact = blotOf(distinctColor(3));
  for (const Blot& blot : {slowless, middle, slow, exact}) EXPECT_GT(blot.count, 100u);
  EXPECT_NEAR(middle.x, 0.5 * (slowless.x + slow.x), 1.0);
  EXPECT_NEAR(middle.y, 0.5 * (slowless.y + slow.y), 1.0);
  EXPECT_GT(slowless.y, slow.y);
  EXPECT_NEAR(exact.x, middle.x, 1.0);
  EXPECT_LT(exact.y, slow.y - 20.0); // a row of its own
}

TEST_F(ChartPicture, DrawsChartsSideBySideAndPointsBeyondTheEndsAtTheEnds)
{
  Chart right = chart;
  chart.series = {seriesAt(0, 1e-9, 0.1)};
  right.series = {seriesAt(1, 1e-5, 0.1)};
  draw({chart, right});
  const Blot first = blotOf(distinctColor(0)), second = blotOf(distinctColor(1));
  EXPECT_NEAR(second.x - first.x, 400.0, 1.0);
  EXPECT_NEAR(second.y, first.y, 1.0);
}

/// Their logarithm does not exist: they stand at the lower end.
TEST_F(ChartPicture, PutsPointsThatAreNotAboveZeroAtTheLowerEnd)
{
  for (const double x : {0.0, -1.0, 1e-9}) {
    chart.series = {seriesAt(0, x, 0.1), seriesAt(1, 1e-5, 1.0)};
    draw({chart});
    EXPECT_GT(blotOf(distinctColor(0)).count, 100u) << x;
    EXPECT_NEAR(blotOf(distinctColor(0)).x, blotOf(distinctColor(1)).x, 0.1) << x;
  }
}

TEST_F(ChartPicture, FaintSeriesAreSmallAndHaveNoLabels)
{
  const auto inkOf = [&](bool faint, const std::string& label) {
    chart.series = {seriesAt(0, 1e-4, 0.1)};
    chart.series[0].faint = faint;
    chart.series[0].points[0].label = label;
    draw({chart});
    return blotOf(distinctColor(0)).count;
  };
  const std::size_t mark = inkOf(false, ""), faint = inkOf(true, "");
  EXPECT_NEAR(static_cast<double>(faint), static_cast<double>(mark) * 16 / 81, 20) << "by the squares of 4 and 9";
  EXPECT_GT(inkOf(false, "label"), mark);
  EXPECT_EQ(inkOf(true, "label"), faint);
}

TEST_F(ChartPicture, JoinsASeriesAndTellsHollowFromFilled)
{
  chart.series = {seriesAt(0, 1e-5, 0.1)};
  draw({chart});
  const std::size_t filled = blotOf(distinctColor(0)).count;
  chart.series[0].filled = false;
  draw({chart});
  EXPECT_LT(blotOf(distinctColor(0)).count, filled);
  EXPECT_GT(blotOf(distinctColor(0)).count, filled / 4) << "a rim is left";
  chart.series[0].points.push_back({1e-3, 0.1, ""});
  draw({chart});
  const std::size_t apart = blotOf(distinctColor(0)).count;
  chart.series[0].joined = true;
  draw({chart});
  EXPECT_GT(blotOf(distinctColor(0)).count, apart + 1000);
}

/// By how many pixels each has: a circle more than a diamond, which is a square that stands on a corner.
TEST_F(ChartPicture, MarksHaveTheirShapes)
{
  std::map<Mark, double> area;
  for (const Mark mark : {Mark::circle, Mark::square, Mark::triangle, Mark::diamond}) {
    chart.series = {seriesAt(0, 1e-4, 0.1)};
    chart.series[0].mark = mark;
    draw({chart});
    area[mark] = static_cast<double>(blotOf(distinctColor(0)).count);
  }
  const double radius_squared = area[Mark::square] / (2 * 1.25 * 1.25);
  EXPECT_NEAR(area[Mark::circle] / radius_squared, 3.14, 0.3);
  EXPECT_NEAR(area[Mark::diamond], area[Mark::square], 0.1 * area[Mark::square]);
  EXPECT_NEAR(area[Mark::triangle] / radius_squared, 1.35 * 1.35 * 1.30, 0.3);
}

/// Labels that find no room are left out.
TEST_F(ChartPicture, DrawsAsManyLabelsAsThereIsRoomFor)
{
  const auto inkOf = [&](std::size_t labels) {
    chart.series = {seriesAt(0, 1e-4, 0.1)};
    chart.series[0].points.assign(labels, {1e-4, 0.1, "label"});
    draw({chart});
    return blotOf(distinctColor(0)).count;
  };
  const std::size_t some = inkOf(30), more = inkOf(60);
  EXPECT_GT(some, inkOf(1));
  EXPECT_EQ(more, some);
}

/// One beside the other, as far apart as the first one's name is long.
TEST_F(ChartPicture, TheLegendNamesEachSeriesOnce)
{
  const auto apart = [&](const std::string& name) {
    chart.series = {seriesAt(0, 1e-9, 0.1), seriesAt(1, 1e-9, 1.0), seriesAt(0, 1e-9, 0.01)};
    for (Series& series : chart.series) series.points.clear(); // the legend alone
    chart.series[0].name = chart.series[2].name = name;
    chart.series[1].name = "other";
    draw({chart});
    return blotOf(distinctColor(1)).x - blotOf(distinctColor(0)).x;
  };
  const double little = apart("i"), more = apart("a name that is much longer");
  EXPECT_GT(little, 30.0);
  EXPECT_GT(more, little + 100.0);
}

/// The left chart's as well, at the picture's edge.
TEST_F(ChartPicture, TitlesOfYAreWhole)
{
  draw({chart, chart});
  const auto inkBetween = [&](int first, int last) {
    std::size_t dark = 0;
    for (int y = 0; y < image->GetDimensions()[1]; ++y)
      for (int x = first; x < last; ++x)
        dark += static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0))[0] < 128;
    return dark;
  };
  EXPECT_GT(inkBetween(0, 60), 50u);
  EXPECT_EQ(inkBetween(0, 60), inkBetween(385, 460)) << "nothing of the right one's is left of it";
}

/// Where there is room for its text.
TEST_F(ChartPicture, DrawsASpanBetweenItsEnds)
{
  const auto ink = [&](const std::vector<Span>& spans) {
    chart.series = {seriesAt(0, 1e-4, 0.1)};
    chart.spans = spans;
    draw({chart});
    std::size_t dark = 0;
    const int* const size = image->GetDimensions();
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x)
        dark += static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0))[0] < 128;
    return dark;
  };
  const std::size_t none = ink({}), little = ink({{1e-4, 1.5e-4, "1.5 times"}}),
                    much = ink({{1e-5, 1e-3, "100 times"}});
  EXPECT_EQ(little, none) << "no room";
  EXPECT_GT(much, none + 800);
}

/// Where no mark of the lowest row covers it.
TEST_F(ChartPicture, PutsTheTextOfASpanIntoItsWidestGap)
{
  const auto inkIn = [&](double from, double to) { // of the lowest row, between the shares of the axis
    std::size_t dark = 0;
    for (int y = 104; y < 162; ++y)
      for (int x = static_cast<int>(left + from * (right - left)); x < left + to * (right - left); ++x)
        dark += static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0))[0] < 100;
    return dark;
  };
  chart.series = {seriesAt(0, 1e-5, 0.0), seriesAt(1, 1e-3, 0.0)};
  draw({chart});
  left = blotOf(distinctColor(0)).x;
  right = blotOf(distinctColor(1)).x;
  const auto atShare = [](double share) { return 1e-5 * std::pow(100.0, share); };
  std::array<double, 2> span = {0.0, 1.0};
  const auto textAt = [&](const std::vector<double>& shares, double y) {
    chart.spans = {{atShare(span[0]), atShare(span[1]), "MMM"}};
    chart.series.clear();
    for (const double share : shares) chart.series.push_back(seriesAt(4, atShare(share), y));
    draw({chart});
    std::size_t most = 0;
    double at = 0.0;
    for (double share = 0.1; share < 0.9; share += 0.05) {
      const std::size_t dark = inkIn(share - 0.05, share + 0.05);
      if (dark > most) most = dark, at = share;
    }
    return at;
  };
  EXPECT_NEAR(textAt({}, 0.0), 0.5, 0.06);
  EXPECT_NEAR(textAt({0.4}, 0.0), 0.7, 0.06);
  EXPECT_NEAR(textAt({0.6}, 0.0), 0.3, 0.06);
  EXPECT_NEAR(textAt({0.8, 0.2}, 0.0), 0.5, 0.06) << "in whichever order";
  EXPECT_NEAR(textAt({0.4}, 0.1), 0.5, 0.06) << "of another row";
  EXPECT_NEAR(textAt({0.0, 1.0}, 0.0), 0.5, 0.06) << "at its ends";
  span = {0.5, 1.0};
  EXPECT_NEAR(textAt({0.0}, 0.0), 0.75, 0.06) << "before it";
  span = {0.0, 0.5};
  EXPECT_NEAR(textAt({1.0}, 0.0), 0.25, 0.06) << "behind it";
}

TEST_F(ChartPicture, DrawsASpreadWithBothItsEnds)
{
  const auto blotWith = [&](const std::array<double, 2>& spread) {
    chart.series = {seriesAt(0, 1e-4, 0.1)};
    chart.series[0].points[0].spread = spread;
    draw({chart});
    return blotOf(distinctColor(0));
  };
  const Blot mark = blotWith({}), bar = blotWith({1e-5, 1e-3}), end = blotWith({1e-3, 1e-3});
  EXPECT_GT(bar.count, mark.count + 400);
  EXPECT_NEAR(bar.x, mark.x, 1.0) << "as far to the left as to the right";
  EXPECT_NEAR(bar.y, mark.y, 1.0);
  EXPECT_GT(end.count, mark.count + 16) << "an end is higher than the bar";
  EXPECT_GT(end.x, mark.x + 5.0);
  EXPECT_NEAR(end.y, mark.y, 1.0) << "as far up as down";
}

} // namespace
} // namespace pcl_bsh::vtk
