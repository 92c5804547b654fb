// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

LocalFrame frameBetween(const std::array<double, 3>& low, const std::array<double, 3>& high, bool float_origin)
{
  LocalFrame frame;
  double half = 0.0; // of the largest extent: the extent itself might overflow
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double middle = low[k] / 2 + high[k] / 2;
    frame.origin[k] = float_origin ? static_cast<double>(roundToFloat(middle)) : middle;
    half = std::max(half, high[k] / 2 - low[k] / 2);
    largest = std::max({largest, std::abs(low[k]), std::abs(high[k])});
  }
  // Squares of coordinates must neither overflow nor vanish in float, nor may the origin overflow in double.
  if (half > 0.0 && (half < 0x1p-30 || half > 0x1p59)) {
    const int least = std::max(-1000, std::ilogb(largest) - 1000);
    frame.unit = std::exp2(std::clamp(std::ilogb(half) + 1, least, 1000));
  }
  const double inverse = 1.0 / frame.unit;
  for (std::size_t k = 0; k < 3; ++k) {
    const double origin = frame.origin[k] * inverse;
    const double reach = std::max(high[k] * inverse - origin, origin - low[k] * inverse);
    frame.reach[k] = reach * (1.0 + 0x1p-20) + 0x1p-140;
  }
  return frame;
}

} // namespace pcl_bsh
