// SPDX-License-Identifier: BSD-3-Clause
// Directions of triangles of any size: what is as small as 1e-100 has normals whose squares are not in the range of
// double.
#pragma once

#include <pcl_bsh/geometry/triangle/vector3.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

/// A power of two by which lengths become about 1 where their fourth powers would leave the range of double; else 1.
/// @param largest of them, >= 0
inline double toOrdinary(double largest)
{
  constexpr double least = 0x1p-200, most = 0x1p200;
  if ((largest > least && largest < most) || !(largest > 0.0) || !std::isfinite(largest)) return 1.0;
  return std::ldexp(1.0, std::clamp(-std::ilogb(largest), -1000, 1000));
}

/// A vector of the direction of v, of a length whose fourth power is in the range of double.
inline Vector3<double> ofOrdinaryLength(const Vector3<double>& v)
{
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}), factor = toOrdinary(largest);
  if (factor == 1.0) return v;
  return std::ldexp(1.0, -std::ilogb(factor * largest)) * (factor * v); // 2^1000 is too small a factor for denormals
}

} // namespace pcl_bsh
