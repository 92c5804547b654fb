// SPDX-License-Identifier: BSD-3-Clause
// Centres for enclosing spheres. Only centres: the code that stores a sphere measures its radius over the points and
// rounds it outward, so that no point is outside, whichever fit is used.
#pragma once

#include <pcl_bsh/export.h>

#include <array>
#include <cstddef>

namespace pcl_bsh {

/// count > 0 points as three arrays.
struct PointArrays {
  const float* x;
  const float* y;
  const float* z;
  std::size_t count;
};

/// Ritter, An Efficient Bounding Sphere (Graphics Gems, 1990): two passes, some 7 % above the smallest radius.
std::array<float, 3> ritterCenter(const PointArrays& points);

/// The centre of the smallest enclosing sphere, to double rounding: Welzl, Smallest Enclosing Disks (Balls and
/// Ellipsoids) (1991), with the move-to-front of Gaertner (1999), in linear expected time.
PCL_BSH_EXPORT_INTERNAL std::array<float, 3> minimalCenter(const PointArrays& points);

} // namespace pcl_bsh
