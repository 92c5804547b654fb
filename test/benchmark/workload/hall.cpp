// SPDX-License-Identifier: BSD-3-Clause
#include "hall.h"

#include "random.h"
#include "statue.h"

#include <algorithm>
#include <limits>

namespace pcl_bsh::bench {
namespace {

using Vector = std::array<double, 3>;

struct Box {
  Vector low, high;
};

constexpr Box kHall = {{0, 0, 0}, {60, 30, 10}};

/// Pillars that stay, and crates of which every other one moves.
std::vector<Box> furniture(bool crates_moved, std::uint64_t seed)
{
  std::vector<Box> boxes;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 2; ++j) {
      const double x = 10.0 + 10.0 * i, y = 10.0 + 10.0 * j;
      boxes.push_back({{x - 0.3, y - 0.3, 0}, {x + 0.3, y + 0.3, 10}});
    }
  Random random(seed);
  for (int i = 0; i < 40; ++i) {
    double x = random.uniform(1, 57), y = random.uniform(1, 27);
    const double w = random.uniform(0.4, 2), h = random.uniform(0.4, 2);
    if (crates_moved && i % 2 == 0) x += 0.3, y += 0.2;
    boxes.push_back({{x, y, 0}, {x + w, y + w, h}});
  }
  return boxes;
}

/// Where the ray enters and leaves the box; entry > exit: it misses.
std::array<double, 2> crossing(const Box& box, const Vector& from, const Vector& direction)
{
  std::array<double, 2> t = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < 3; ++k) {
    const double t0 = (box.low[k] - from[k]) / direction[k], t1 = (box.high[k] - from[k]) / direction[k];
    t[0] = std::max(t[0], std::min(t0, t1));
    t[1] = std::min(t[1], std::max(t0, t1));
  }
  return t;
}

double range(const std::vector<Box>& boxes, const Vector& from, const Vector& direction)
{
  double nearest = crossing(kHall, from, direction)[1]; // seen from inside
  for (const Box& box : boxes) {
    const auto t = crossing(box, from, direction);
    if (t[0] <= t[1] && t[0] > 0.0) nearest = std::min(nearest, t[0]);
  }
  return nearest;
}

Points sweep(std::size_t count, const Vector& sensor, const std::vector<Box>& boxes, Random random)
{
  constexpr std::size_t kChannels = 64;
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kLowest = -25.0 * kPi / 180, kHighest = 15.0 * kPi / 180;
  constexpr double kRangeNoise = 0.01, kAngleNoise = 1e-4;
  const std::size_t columns = std::max<std::size_t>(1, count / kChannels);
  Points points;
  points.reserve(columns * kChannels);
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      const double azimuth =
          2 * kPi * static_cast<double>(column) / static_cast<double>(columns) + kAngleNoise * random.bell();
      const double elevation =
          kLowest + (kHighest - kLowest) * static_cast<double>(channel) / (kChannels - 1) + kAngleNoise * random.bell();
      const Vector direction = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation)};
      const double r = range(boxes, sensor, direction) + kRangeNoise * random.bell();
      points.push_back({static_cast<float>(sensor[0] + r * direction[0]),
                        static_cast<float>(sensor[1] + r * direction[1]),
                        static_cast<float>(sensor[2] + r * direction[2])});
    }
  }
  return points;
}

/// The hall's six walls, evenly sampled row by row.
void appendWalls(Points& points, std::size_t count, Random& random)
{
  double area = 0.0;
  for (std::size_t k = 0; k < 3; ++k) area += 2 * kHall.high[(k + 1) % 3] * kHall.high[(k + 2) % 3];
  const double spacing = std::sqrt(area / static_cast<double>(count));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
    for (const double wall : {kHall.low[k], kHall.high[k]}) {
      for (double row = 0.5 * spacing; row < kHall.high[v]; row += spacing) {
        for (double column = 0.5 * spacing; column < kHall.high[u]; column += spacing) {
          Vector p;
          p[k] = wall + 0.005 * random.bell();
          p[u] = column + spacing * random.uniform(-0.3, 0.3);
          p[v] = row + spacing * random.uniform(-0.3, 0.3);
          points.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
        }
      }
    }
  }
}

/// The statue's surface is the same for both scans; only the samples on it differ.
Points statueScene(const Points& samples, double push, Random random)
{
  Points points = moved(samples, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {30 + push, 15, 1.4}});
  appendWalls(points, samples.size(), random);
  return points;
}

} // namespace

ScanPair sweepPair(std::size_t count, std::uint64_t seed)
{
  ScanPair pair{sweep(count, {20, 13, 1.8}, furniture(false, seed), Random(2 * seed)),
                sweep(count, {24, 15, 1.8}, furniture(true, seed), Random(2 * seed + 1)), 0.0};
  pair.spacing = medianSpacing(pair.a);
  return pair;
}

ScanPair statueInHall(std::size_t count, std::uint64_t seed)
{
  // One dense statue, dealt out to the two scans point by point: the same surface sampled at different places.
  const Points both = statue(count / 2 * 2, seed);
  Points a, b;
  for (std::size_t i = 0; i < both.size(); ++i) (i % 2 == 0 ? a : b).push_back(both[i]);
  const double spacing = medianSpacing(a);
  return {statueScene(a, 0.0, Random(2 * seed)), statueScene(b, 0.05, Random(2 * seed + 1)), spacing};
}

} // namespace pcl_bsh::bench
