// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>

namespace pcl_bsh {

LocalFrame frameBetween(const std::array<double, 3>& low, const std::array<double, 3>& high, bool float_origin)
{
  LocalFrame frame;
  double reach = 0.0;
  std::array<double, 3> half; // of the largest offset from the origin: the offset itself might overflow
  for (std::size_t k = 0; k < 3; ++k) {
    const double middle = low[k] / 2 + high[k] / 2;
    frame.origin[k] = float_origin ? static_cast<double>(roundToFloat(middle)) : middle;
    half[k] = std::max(high[k] / 2 - frame.origin[k] / 2, frame.origin[k] / 2 - low[k] / 2);
    reach = std::max(reach, half[k]);
  }
  // Squares of coordinates must neither overflow nor vanish in float.
  if (reach > 0.0 && (reach < 0x1p-30 || reach > 0x1p59))
    frame.unit = std::exp2(std::clamp(std::ilogb(reach) + 1, -1000, 1000));
  for (std::size_t k = 0; k < 3; ++k) frame.reach[k] = 2 * (half[k] / frame.unit) * (1.0 + 0x1p-20) + 0x1p-140;
  return frame;
}

} // namespace pcl_bsh
