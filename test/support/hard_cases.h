// SPDX-License-Identifier: BSD-3-Clause
// The catalogue in test/hard_cases: inputs that other tools are known to answer wrongly, or not at all, with the answer
// of exact arithmetic.
#pragma once

#include "random_clouds.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh::hard_cases {

using Points = std::vector<Point3>;

inline const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
inline constexpr std::size_t unknown = ~std::size_t{0};

inline float f(double x)
{
  return static_cast<float>(x);
}

struct HardCase {
  std::string name;
  Points a, b;
  double clearance;
  std::size_t colliding_pairs = unknown; ///< ordered pairs, in exact arithmetic; unknown: so are the next three
  Scalar scalar = Scalar::float32;
  Eigen::Isometry3d pose_a = identity, pose_b = identity; ///< of the catalogue's, b's alone
  std::size_t colliding_a = unknown, colliding_b = unknown;
  double smallest_distance = std::numeric_limits<double>::infinity(); ///< rounded to the nearest double
};

inline Points listOf(int count, const std::function<Point3(int)>& point)
{
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(point(i));
  return points;
}

/// In exact arithmetic.
std::size_t countPairs(const HardCase& c);

/// All of the catalogue. @throws std::exception naming the file that is not as it should be
std::vector<HardCase> catalogue();

} // namespace pcl_bsh::hard_cases
