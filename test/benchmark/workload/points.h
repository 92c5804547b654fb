// SPDX-License-Identifier: BSD-3-Clause
// Points and rigid poses as the workloads make them and the peers read them: plain records, no library behind them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh::bench {

struct Point {
  float x, y, z;
};

using Points = std::vector<Point>;

/// Squared distance in float, as every peer computes it.
inline float squaredDistance(const Point& p, const Point& q)
{
  const float dx = p.x - q.x, dy = p.y - q.y, dz = p.z - q.z;
  return dx * dx + dy * dy + dz * dz;
}

/// Squared distance of the given floats in double: settles what float peers disagree about.
inline double squaredDistanceDouble(const Point& p, const Point& q)
{
  const double dx = double{p.x} - q.x, dy = double{p.y} - q.y, dz = double{p.z} - q.z;
  return dx * dx + dy * dy + dz * dz;
}

/// x -> R x + t, with R row by row.
struct RigidPose {
  std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation = {0, 0, 0};

  std::array<double, 3> apply(const std::array<double, 3>& p) const
  {
    std::array<double, 3> q;
    for (std::size_t i = 0; i < 3; ++i)
      q[i] = rotation[3 * i] * p[0] + rotation[3 * i + 1] * p[1] + rotation[3 * i + 2] * p[2] + translation[i];
    return q;
  }

  Point apply(const Point& p) const
  {
    const auto q = apply(std::array<double, 3>{p.x, p.y, p.z});
    return {static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2])};
  }

  RigidPose inverse() const
  {
    RigidPose back;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) back.rotation[3 * i + j] = rotation[3 * j + i];
    const auto t = back.apply(translation);
    back.translation = {-t[0], -t[1], -t[2]};
    return back;
  }
};

/// Moves every point.
Points moved(const Points& points, const RigidPose& pose);

/// The points in an order without any locality, as in merged and tiled files.
Points shuffled(Points points, std::uint64_t seed);

/// Median distance to the nearest other point, over some 2,000 sampled points; exact duplicates do not count.
double medianSpacing(const Points& points);

} // namespace pcl_bsh::bench
