// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <cmath>

namespace pcl_bsh::pipeline {

inline bool isFinite(const Point3& p)
{
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

} // namespace pcl_bsh::pipeline
