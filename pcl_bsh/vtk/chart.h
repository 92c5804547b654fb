// SPDX-License-Identifier: BSD-3-Clause
// A chart of cost against error, or size, on logarithmic axes that may have a row of its own for "not at all": a PNG
// file.
#pragma once

#include <pcl_bsh/export.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::vtk {

/// A mark of an axis, with its text.
struct Tick {
  double value = 0.0; ///< > 0
  std::string text;
};

/// A logarithmic axis.
struct Axis {
  std::string title;
  std::vector<Tick> ticks; ///< ascending, two or more; the first and the last are the ends of the axis
};

/// A point of a series.
struct ChartPoint {
  double x = 0.0, y = 0.0;
  std::string label; ///< empty: none. A label without a free place is left out: the earlier ones of a series stay
  std::array<double, 2> spread = {}; ///< of x, drawn as a bar across the mark; both 0: none
};

/// The shape of a series' points.
enum class Mark { circle, square, triangle, diamond };

/// Points of one look, with a name.
struct Series {
  std::string name; ///< in the legend; empty: not there
  std::array<unsigned char, 3> color = {};
  Mark mark = Mark::circle;
  bool filled = true;
  bool joined = false; ///< by a line, in the order given
  bool faint = false;  ///< small and pale, without labels
  std::vector<ChartPoint> points;
};

/// An arrow between two places of the lowest row, with a text.
struct Span {
  double from = 0.0, to = 0.0;
  std::string text;
};

/// All that a chart shows.
struct Chart {
  std::string title;
  Axis x, y;             ///< points beyond their ends are drawn at the ends
  std::string lowest;    ///< name of the row below the y axis; empty: no such row
  double lowest_y = 0.0; ///< points up to here are in that row
  std::vector<Series> series;
  std::vector<Span> spans;
};

/// Colours that readers with any colour vision tell apart (Okabe, Ito: Color Universal Design, 2008).
std::array<unsigned char, 3> distinctColor(std::size_t i);

/// Draws the charts side by side, under one legend of all series. @throws std::runtime_error naming the file
void writeChartsPng(const std::vector<Chart>& charts, int width, int height, const std::filesystem::path& path);

} // namespace pcl_bsh::vtk
PCL_BSH_EXPORT_END
