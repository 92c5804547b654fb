// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/rounding.h>

#include <cmath>

namespace pcl_bsh {

/// The spacing of float32 numbers at a coordinate: from the largest one that is not above it to the next one towards 0.
/// @param largest >= 0
inline double float32Spacing(double largest)
{
  const float number = roundDown(largest);
  return static_cast<double>(number) - static_cast<double>(std::nextafter(number, 0.0f));
}

} // namespace pcl_bsh
