// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <array>

namespace pcl_bsh {

/// Three corners, which may coincide or lie on one line: the triangle is closed, and then a segment or a point.
using Triangle3 = std::array<Point3, 3>;

inline bool isFinite(const Triangle3& triangle) noexcept
{
  return isFinite(triangle[0]) && isFinite(triangle[1]) && isFinite(triangle[2]);
}

} // namespace pcl_bsh
