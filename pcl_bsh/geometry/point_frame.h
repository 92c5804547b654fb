// SPDX-License-Identifier: BSD-3-Clause
// One point seen from a local frame: what RelativeFrame is to two clouds, but light enough for one point and one voxel.
#pragma once

#include <pcl_bsh/geometry/distance_band.h>
#include <pcl_bsh/geometry/local_frame.h>
#include <pcl_bsh/geometry/point3.h>

namespace pcl_bsh {

/// A point q as the float nearest to (q - origin) / unit, and a bound for the error of distances from it.
///
/// For every given point p of the frame, stored as x: | |p - q| / unit - |x - (stored q)| | <= error. Per axis, x errs
/// by the frame's slack, or not at all in a lossless one, and q by kStoringError of itself. The error is the sum over
/// the axes, which is at least the norm.
class PointFrame {
public:
  PointFrame(const LocalFrame& frame, const Point3& q) noexcept : unit(frame.unit)
  {
    const double inverse = unit == 1.0 ? 1.0 : 1.0 / unit;
    double absolute = 0.0, reach = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double local = q[k] * inverse - frame.origin[k] * inverse;
      at[k] = roundToFloat(local);
      absolute += std::abs(local);
      reach += frame.reach[k];
    }
    error = inFloatRange(absolute) && inFloatRange(reach) && unit >= 0x1p-900 && unit <= 0x1p900
                ? kStoringError * (frame.lossless ? absolute : absolute + reach) + 0x1p-140
                : std::numeric_limits<double>::infinity();
  }

  std::array<float, 3> at; ///< the point, in units
  double unit;             ///< the frame's
  double error;            ///< in units; infinite when the point is out of float's range

  bool inRange() const noexcept { return error < std::numeric_limits<double>::infinity(); }

  /// Which squared float distances from the point tell whether a stored point is within `length` >= 0 units of it.
  DistanceBand band(double length) const noexcept
  {
    if (!inRange() || !inFloatRange(length)) return {-1.0f, std::numeric_limits<float>::infinity()};
    return distanceBand(length, length, error);
  }

  /// At least length + error: a sphere farther away than this and its radius holds no point within `length` units.
  float pruneReach(double length) const noexcept { return static_cast<float>(length + error) * (1.0f + kReachMargin); }

  /// At most length - error: a sphere within this holds only points within `length` units. Negative when no such radius
  /// exists.
  float acceptReach(double length) const noexcept
  {
    const double reach = length - error;
    return reach > kSmallestLength ? static_cast<float>(reach) * (1.0f - kReachMargin) : -1.0f;
  }

  /// Whether the frame's box, and so each of its points, is farther than `length` units from the point.
  bool separates(const LocalFrame& frame, double length) const noexcept
  {
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double outside = std::abs(static_cast<double>(at[k])) - frame.reach[k];
      if (outside > 0.0) squared += outside * outside;
    }
    const double reach = (length + error) * (1.0 + kDoubleMargin);
    return squared > reach * reach * (1.0 + kDoubleMargin);
  }
};

} // namespace pcl_bsh
