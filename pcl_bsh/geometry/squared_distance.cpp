// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/squared_distance.h>

#include <pcl_bsh/geometry/exact/dyadic.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

Dyadic squaredDistance(const Point3& p, const Point3& q)
{
  Dyadic squared;
  for (std::size_t k = 0; k < 3; ++k) {
    const Dyadic difference = Dyadic(p[k]) - Dyadic(q[k]);
    squared += difference * difference;
  }
  return squared;
}

/// Halfway to the next float above x >= 0, as a double: exact. The one above the largest counts as 2^128.
double halfwayAbove(float x)
{
  const double above = x < kLargest ? static_cast<double>(std::nextafter(x, kFloatInfinity)) : 0x1p128;
  return (static_cast<double>(x) + above) / 2;
}

} // namespace

float settleSquaredDistance(const Point3& p, const Point3& q, double approximate)
{
  if (p == q) return 0.0f;
  const Dyadic squared = squaredDistance(p, q);
  const auto belongs_above = [&](float x) {
    const int side = (squared - Dyadic(halfwayAbove(x))).sign();
    const bool odd = (std::bit_cast<std::uint32_t>(x) & 1) != 0;
    return side > 0 || (side == 0 && odd);
  };
  float rounded = approximate < static_cast<double>(kLargest) ? roundToFloat(approximate) : kLargest;
  while (rounded < kFloatInfinity && belongs_above(rounded)) rounded = std::nextafter(rounded, kFloatInfinity);
  while (rounded > 0.0f && !belongs_above(std::nextafter(rounded, 0.0f))) rounded = std::nextafter(rounded, 0.0f);
  return rounded;
}

} // namespace pcl_bsh
