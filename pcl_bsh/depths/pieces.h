// SPDX-License-Identifier: BSD-3-Clause
// Pieces of triangles, and what bounds depths on them (triangle_depths.cpp).
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pcl_bsh {

/// The value of s at a place, which may lie off its triangle by rounding.
struct Sample {
  double low, high, rounded;
  std::uint32_t nearest;
};

struct Piece {
  std::array<std::uint32_t, 3> corners; ///< samples
  unsigned cuts = 0;
  double upper = std::numeric_limits<double>::infinity();
};

inline double wayBetween(const Point3& p, const Point3& q)
{
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

inline Point3 between(const Point3& p, const Point3& q, double share)
{
  Point3 at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = p[k] + share * (q[k] - p[k]);
  return at;
}

/// Returns the greatest value, on a triangle, of the smaller of two linear functions, which are given at its corners.
inline double smallerOfTwo(const std::array<double, 3>& f, const std::array<double, 3>& g)
{
  double greatest = 0.0, sum = 0.0;
  for (unsigned k = 0; k < 3; ++k) sum += std::abs(f[k]) + std::abs(g[k]);
  if (!(sum < std::numeric_limits<double>::infinity())) return sum; // where nothing is known
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned l = (k + 1) % 3;
    greatest = std::max(greatest, std::min(f[k], g[k]));
    const double a = g[k] - f[k], b = f[l] - g[l];
    if ((a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0)) {
      const double share = a / (a + b);
      const double meet = std::max(f[k] + share * (f[l] - f[k]), g[k] + share * (g[l] - g[k]));
      greatest = std::max(greatest, std::min(meet, std::max(f[k], f[l])));
    }
  }
  return greatest * (1.0 + 0x1p-48);
}

} // namespace pcl_bsh
