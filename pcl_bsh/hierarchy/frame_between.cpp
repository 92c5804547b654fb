// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/frame_between.h>

#include <pcl_bsh/geometry/rounding.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

/// Whether x - origin is a float for every float x of [low, high] that is at most `reach` away from the float `origin`.
/// All are whole multiples of the last place of the one nearest to 0.
bool keepsFloats(double low, double high, double origin, double reach)
{
  if (origin == 0.0) return true;
  const double nearest = low > 0.0 ? low : -high;
  return nearest >= static_cast<double>(std::numeric_limits<float>::min()) && std::abs(origin) >= nearest &&
         reach <= std::exp2(std::ilogb(nearest) + 1);
}

/// Whether a frame's origin should be 0 on an axis: no other origin keeps all floats exact, and 0 is so near that
/// spheres around the origin stay small.
bool belongsAtZero(double low, double high, double half)
{
  const double farthest = std::max(std::abs(low), std::abs(high));
  const double nearest = low > 0.0 ? low : std::max(0.0, -high);
  return farthest <= half / 2 && high / 2 - low / 2 > nearest;
}

} // namespace

LocalFrame frameBetween(const std::array<double, 3>& low, const std::array<double, 3>& high, bool float_origin)
{
  return frameBetween(low, high, float_origin, 0.0f);
}

LocalFrame frameBetween(const std::array<double, 3>& low, const std::array<double, 3>& high, bool float_origin,
                        float largest_radius)
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
  // Squares of coordinates must neither overflow nor vanish in float, nor may radii overflow there, or the origin in
  // double.
  if (half > 0.0 && (half < 0x1p-30 || half > 0x1p59)) {
    const int least = std::max(-1000, std::ilogb(largest) - 1000);
    const int of_radii = largest_radius > 0.0f ? std::ilogb(largest_radius) - 100 : -1000;
    frame.unit = std::exp2(std::clamp(std::max(std::ilogb(half) + 1, of_radii), least, 1000));
  }
  frame.lossless = float_origin && frame.unit == 1.0;
  const double inverse = 1.0 / frame.unit;
  for (std::size_t k = 0; k < 3; ++k) {
    if (frame.lossless && belongsAtZero(low[k], high[k], half)) frame.origin[k] = 0.0;
    const double origin = frame.origin[k] * inverse;
    const double reach = std::max(high[k] * inverse - origin, origin - low[k] * inverse);
    frame.lossless = frame.lossless && keepsFloats(low[k], high[k], frame.origin[k], reach);
    frame.reach[k] = reach * (1.0 + kReachGrowth) + kSmallestReach;
  }
  return frame;
}

} // namespace pcl_bsh
