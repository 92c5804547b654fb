// SPDX-License-Identifier: BSD-3-Clause
// Curves on logarithmic axes, as a PNG file.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::vtk {

struct Curve {
  std::string name;
  std::vector<double> x, y;                ///< as many of each; what is 0, or nearly, is drawn at the axis' lower end
  std::array<unsigned char, 3> color = {}; ///< red, green, blue
  bool dashed = false;
  bool line = true; ///< false: marks only
};

struct Chart {
  std::string title;
  std::string x_label, y_label; ///< with units
  std::vector<Curve> curves;
};

/// Colours that readers with any colour vision tell apart (Okabe, Ito: Color Universal Design, 2008).
std::array<unsigned char, 3> distinctColor(std::size_t i);

/// Draws the charts one below the other. @throws std::runtime_error naming the file
void writeChartsPng(const std::vector<Chart>& charts, int width, int height_each, const std::filesystem::path& path);

} // namespace pcl_bsh::vtk
