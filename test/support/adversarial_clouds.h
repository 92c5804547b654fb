// SPDX-License-Identifier: BSD-3-Clause
// Clouds that are hard for searches by bounding volumes: many points, or many pairs, are at nearly the same distance,
// or a few points spoil the bounds of all. Each is made for any number of points, so that work can be held as it grows.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include "random.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace pcl_bsh::test {

/// One cloud and where to ask about its neighbours.
struct HardCloud {
  std::vector<Point3> points;
  std::vector<Point3> queries;
  double radius = 0.0; ///< of radius searches
};

/// Two clouds, the second one posed.
struct HardPair {
  std::vector<Point3> a, b;
  double clearance = 0.0;
  Eigen::Isometry3d pose_b = Eigen::Isometry3d::Identity();
};

namespace adversarial {

inline Point3 direction(Random& random)
{
  for (;;) {
    const Point3 p = random.point([&] { return random.uniform(-1, 1); });
    const double norm = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    if (norm > 0.1 && norm <= 1.0) return {p[0] / norm, p[1] / norm, p[2] / norm};
  }
}

inline Point3 scaled(const Point3& p, double factor)
{
  return {p[0] * factor, p[1] * factor, p[2] * factor};
}

inline std::vector<Point3> cube(std::size_t n, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Point3> points(n);
  for (Point3& p : points) p = random.point([&] { return random.uniform(-1, 1); });
  return points;
}

/// Shells about 0, of radii from 1 upwards, each by `gap` larger than the one before.
inline std::vector<Point3> shells(std::size_t n, std::size_t count, double gap)
{
  Random random(1);
  std::vector<Point3> points(n);
  for (std::size_t i = 0; i < n; ++i) points[i] = scaled(direction(random), 1.0 + gap * static_cast<double>(i % count));
  return points;
}

/// Columns times rows, 1 apart, in the plane z.
inline std::vector<Point3> sheet(std::size_t n, double shift, double z)
{
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(n)));
  std::vector<Point3> points;
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j)
      points.push_back({static_cast<double>(i) + shift, static_cast<double>(j) + shift, z});
  return points;
}

/// On the z axis from -length to length.
inline std::vector<Point3> axis(std::size_t n, double length)
{
  std::vector<Point3> points(n);
  for (std::size_t i = 0; i < n; ++i)
    points[i] = {0, 0, length * (2.0 * static_cast<double>(i) / static_cast<double>(n) - 1.0)};
  return points;
}

/// About the origin, as many in each of so many powers of two of the distance.
inline std::vector<Point3> octaves(std::size_t n, double count, std::uint64_t seed)
{
  Random random(seed);
  std::vector<Point3> points(n);
  for (Point3& p : points) {
    const double size = std::exp2(-count * random.uniform(0, 1)); // drawn before the direction by any compiler
    p = scaled(direction(random), size);
  }
  return points;
}

/// About the z axis, `turns` times around and `rise` along it each time.
inline std::vector<Point3> helix(std::size_t n, double turns, double rise, double phase = 0.0, double radius = 1.0)
{
  std::vector<Point3> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = turns * static_cast<double>(i) / static_cast<double>(n) + phase;
    points[i] = {radius * std::cos(2 * std::numbers::pi * turn), radius * std::sin(2 * std::numbers::pi * turn),
                 rise * turn};
  }
  return points;
}

/// Teeth: as many lines along z, 1 apart, as points in each.
inline std::vector<Point3> comb(std::size_t n, double shift)
{
  const auto teeth = static_cast<std::size_t>(std::sqrt(static_cast<double>(n)));
  std::vector<Point3> points;
  for (std::size_t i = 0; i < teeth; ++i)
    for (std::size_t j = 0; j < teeth; ++j)
      points.push_back(
          {static_cast<double>(i) + shift, 0, 100.0 * static_cast<double>(j) / static_cast<double>(teeth)});
  return points;
}

/// Some of them replaced by others, spread evenly.
inline std::vector<Point3> with(std::vector<Point3> points, const std::vector<Point3>& more)
{
  for (std::size_t i = 0; i < more.size(); ++i) points[(2 * i + 1) * points.size() / (2 * more.size())] = more[i];
  return points;
}

} // namespace adversarial
} // namespace pcl_bsh::test
