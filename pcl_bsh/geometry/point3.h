// SPDX-License-Identifier: BSD-3-Clause
// A place in space, as all rooms pass it on.
#pragma once

#include <pcl_bsh/export.h>

#include <array>
#include <cmath>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Three coordinates in double: exact for float32 and float64 input alike.
using Point3 = std::array<double, 3>;

/// Whether queries count the point: no coordinate is NaN or infinite.
inline bool isFinite(const Point3& p) noexcept
{
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
