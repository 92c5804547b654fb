// SPDX-License-Identifier: BSD-3-Clause
#include "terrain.h"

#include "noise.h"

#include <algorithm>

namespace pcl_bsh::bench {
namespace {

constexpr double kShift = 0.3;         // of the extent, along the rows
constexpr double kJitter = 0.3;        // of the spacing, either way
constexpr double kNoise = 0.05;        // of the spacing, one standard deviation
constexpr double kChangedTile = 0.125; // of the extent: the change comes in square tiles, like new houses and pits

double hills(double x, double y, std::uint64_t seed)
{
  return octaveNoise({x, y, 0.0}, 256.0, 24.0, 7, seed);
}

/// How far the ground was raised between the two scans: one tile in four, by 3, 12 or 40 spacings.
double raised(double x, double y, double extent, std::uint64_t seed)
{
  const auto tile_x = static_cast<std::uint64_t>(x / (kChangedTile * extent));
  const auto tile_y = static_cast<std::uint64_t>(y / (kChangedTile * extent));
  const std::uint64_t bits = mix(seed ^ mix(tile_x * 1024 + tile_y));
  if (bits % 4 != 0) return 0.0;
  constexpr double kHeights[] = {3.0, 12.0, 40.0};
  return kHeights[(bits >> 8) % 3];
}

Points scan(std::size_t side, double x0, bool changed, std::uint64_t seed, Random random)
{
  const auto extent = static_cast<double>(side);
  Points points;
  points.reserve(side * side);
  for (std::size_t row = 0; row < side; ++row) {
    for (std::size_t column = 0; column < side; ++column) {
      // A mirror swings to and fro: odd rows run backwards, so neighbours in memory are neighbours on the ground.
      const std::size_t step = row % 2 == 0 ? column : side - 1 - column;
      const double x = x0 + static_cast<double>(step) + random.uniform(-kJitter, kJitter) + 0.5;
      const double y = static_cast<double>(row) + random.uniform(-kJitter, kJitter) + 0.5;
      double z = hills(x, y, seed) + kNoise * random.bell();
      if (changed) z += raised(x, y, extent, seed);
      points.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    }
  }
  return points;
}

} // namespace

ScanPair terrainPair(std::size_t count, std::uint64_t seed)
{
  const auto side = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(static_cast<double>(count)) + 0.5));
  const double shift = kShift * static_cast<double>(side);
  return {scan(side, 0.0, false, seed, Random(2 * seed)), scan(side, shift, true, seed, Random(2 * seed + 1)), 1.0};
}

} // namespace pcl_bsh::bench
