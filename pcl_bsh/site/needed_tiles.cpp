// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/needed_tiles.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_bsh::sites {

namespace {

constexpr double parts_of_longest = 8; ///< a box is cut into cubes, about so many along its longest side

} // namespace

TileBalls::TileBalls(const Site& site)
{
  for (std::uint32_t i = 0; i < site.tiles.size(); ++i)
    if (site.tiles[i].bounds) cover(*site.tiles[i].bounds, i);
}

/// Cuts the box into parts that are nearly cubes; a ball about each reaches its corners. Computed corners are off by a
/// few units in the last place of the largest coordinate, for which radii are larger.
void TileBalls::cover(const Bounds& bounds, std::uint32_t tile)
{
  Point3 side;
  double longest = 0.0, farthest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    side[k] = bounds.high[k] - bounds.low[k];
    longest = std::max(longest, side[k]);
    farthest = std::max({farthest, std::abs(bounds.low[k]), std::abs(bounds.high[k])});
  }
  std::array<int, 3> parts = {1, 1, 1};
  double square = 0.0;
  const bool divides = std::isfinite(longest) && longest > 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (divides) parts[k] = std::max(1, static_cast<int>(std::ceil(parts_of_longest * side[k] / longest)));
    side[k] /= parts[k];
    square += side[k] / 2 * (side[k] / 2);
  }
  const double radius = std::sqrt(square) * (1.0 + 1e-6) + farthest * 1e-14 + 1e-300;
  const float reach = std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity());
  for (int x = 0; x < parts[0]; ++x)
    for (int y = 0; y < parts[1]; ++y)
      for (int z = 0; z < parts[2]; ++z) {
        const Point3 center = {bounds.low[0] + (x + 0.5) * side[0], bounds.low[1] + (y + 0.5) * side[1],
                               bounds.low[2] + (z + 0.5) * side[2]};
        centers_.push_back(center);
        radii_.push_back(reach);
        tiles_.push_back(tile);
      }
}

PointsView TileBalls::view() const
{
  PointsView view = viewOf(centers_.empty() ? nullptr : centers_.front().data(), centers_.size());
  view.radii = radii_.data();
  return view;
}

} // namespace pcl_bsh::sites
