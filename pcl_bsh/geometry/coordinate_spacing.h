// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <cmath>

namespace pcl_bsh {

/// The distance of neighbouring float32 numbers where coordinates are as large as this.
/// @param largest >= 0
inline double float32Spacing(double largest)
{
  const float number = roundDown(largest);
  return static_cast<double>(number) - static_cast<double>(std::nextafter(number, 0.0f));
}

} // namespace pcl_bsh
