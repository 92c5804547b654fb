// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/export.h>

#include <array>
#include <cmath>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Three coordinates in double: exact for float32 and float64 input alike.
using Point3 = std::array<double, 3>;

inline bool isFinite(const Point3& p) noexcept
{
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
