// SPDX-License-Identifier: BSD-3-Clause
// Colours that readers with any colour vision tell apart (Okabe, Ito: Color Universal Design, 2008), on a dark ground.
#pragma once

#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_bsh::viewer {

using Color = std::array<unsigned char, 3>;

inline constexpr Color ground = {24, 30, 38};
inline constexpr Color text_color = {235, 238, 242};
inline constexpr Color scan_color = {126, 140, 154};
inline constexpr Color obstacle_color = {86, 180, 233};
inline constexpr Color compared_color = {84, 92, 102};  ///< of clouds that distances lead to; colours are for distances
inline constexpr Color colliding_color = {255, 106, 0}; ///< vermillion, brighter than in print
inline constexpr Color undecided_color = {204, 121, 167};
inline constexpr Color sparse_color = {0, 158, 115};
inline constexpr Color unseen_color = {0, 114, 178};
inline constexpr Color obstacle_colliding_color = {240, 228, 66};
/// The colours of obstacles that have names, one after another. None is a colour of verdicts.
inline constexpr std::array<Color, 6> named_colors = {
    {obstacle_color, {150, 226, 186}, {178, 163, 255}, {255, 178, 200}, {226, 228, 232}, {110, 202, 196}}};
inline constexpr Color sphere_color = {86, 180, 233};
inline constexpr Color voxel_color = {0, 158, 115};
inline constexpr Color cell_color = {204, 121, 167};
inline constexpr Color segment_color = {240, 228, 66};
inline constexpr Color contact_color = {64, 224, 208};
inline constexpr Color overlap_color = {255, 64, 64}; ///< of contacts whose gap is below 0
inline constexpr Color open_edge_color = {255, 64, 64};
inline constexpr Color path_color = {204, 121, 167};

/// Colours by SphereFate.
inline constexpr std::array<Color, 4> fate_colors = {{{120, 128, 138}, {86, 180, 233}, {0, 158, 115}, {255, 106, 0}}};

inline std::array<double, 3> fractions(const Color& color)
{
  return {color[0] / 255.0, color[1] / 255.0, color[2] / 255.0};
}

/// The colour after a share, 0 to 1, of the way through `stops`.
template <std::size_t N>
std::array<double, 3> between(const std::array<std::array<double, 3>, N>& stops, double share_of_way)
{
  const double at = share_of_way * (N - 1.0);
  const auto from = std::min(static_cast<std::size_t>(at), N - 2);
  std::array<double, 3> c;
  for (std::size_t k = 0; k < 3; ++k)
    c[k] = std::lerp(stops[from][k], stops[from + 1][k], at - static_cast<double>(from)) / 255.0;
  return c;
}

/// Dark to bright through violet, teal and yellow; `reversed`: bright to dark. Where `low` is below 0, these
/// colours begin at 0, and values below go from pale orange to dark red at `low`.
inline vtkSmartPointer<vtkLookupTable> colorTable(double low, double high, bool reversed)
{
  constexpr std::array<std::array<double, 3>, 6> stops = {
      {{122, 88, 196}, {72, 116, 186}, {38, 148, 150}, {60, 185, 115}, {160, 218, 57}, {253, 231, 37}}};
  constexpr std::array<std::array<double, 3>, 3> depths = {{{255, 176, 102}, {255, 106, 0}, {150, 20, 20}}};
  constexpr int count = 256;
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(count);
  for (int i = 0; i < count; ++i) {
    const double share = (reversed ? count - 1 - i : i) / (count - 1.0);
    const double value = low + share * (high - low);
    const std::array<double, 3> c = !(low < 0.0)  ? between(stops, share)
                                    : value < 0.0 ? between(depths, value / low)
                                                  : between(stops, high > 0.0 ? value / high : 0.0);
    table->SetTableValue(i, c[0], c[1], c[2]);
  }
  table->SetTableRange(low, high > low ? high : low + 1.0);
  table->Build();
  return table;
}

} // namespace pcl_bsh::viewer
