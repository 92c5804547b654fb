// SPDX-License-Identifier: BSD-3-Clause
// A query for the nearest points in the frame of one voxel, or of the tree above the voxels.

#if defined(PCL_BSH_NEIGHBORS_NEAREST_FRAME_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_NEIGHBORS_NEAREST_FRAME_INL_H_
#undef PCL_BSH_NEIGHBORS_NEAREST_FRAME_INL_H_
#else
#define PCL_BSH_NEIGHBORS_NEAREST_FRAME_INL_H_
#endif

#include <pcl_bsh/geometry/point_frame.h>
#include <pcl_bsh/simd/point_lanes-inl.h>

#include <bit>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The query in one frame, and how a squared float distance s there bounds the squared distance in the search's unit:
/// that is within [s / inverse_below - slack, s * above + slack].
///
/// With rho the frame's error and any e > 0, (sqrt(s) + rho)^2 <= s (1 + e) + rho^2 (1 + 1/e); the lower bound is
/// alike. Here e = kNeighborShare, and as much again pays for float arithmetic. The lower bound has twice both. Where
/// floats bound nothing, the query is at 0, every upper bound is infinite and nothing is left out. This is also so
/// where units are so far apart that upper bounds overflow. None of these numbers is NaN, nor are those that the walk
/// derives.
struct NearestFrame {
  NearestFrame(const PointFrame& point, double search_unit)
  {
    const double unit = point.unit == search_unit ? 1.0 : point.unit / search_unit;
    const double scale = unit * unit;
    if (!(point.inRange() && scale >= kSmallestScale && scale <= 1.0 / kSmallestScale)) return;
    at = {point.at[0], point.at[1], point.at[2]};
    error = static_cast<float>(point.error);
    slack = static_cast<float>(scale * point.error * point.error / kNeighborShare) * (1.0f + 32 * kNeighborShare) +
            kVanishing;
    if (unit == 1.0) return;
    inverse_unit = static_cast<float>(1.0 / unit);
    inverse_below *= static_cast<float>(1.0 / scale);
    above *= static_cast<float>(scale);
  }

  /// Squared float distances above this are beyond `bound`.
  float miss(float bound) const { return (bound + slack) * inverse_below; }

  /// Spheres whose centres are farther than this plus their radius are beyond `distance`.
  float reach(float distance) const { return (distance * inverse_unit + error) * (1.0f + kNeighborMargin); }

  static constexpr float kVanishing = 0x1p-100f;     ///< above what underflows, as a squared distance
  static constexpr double kSmallestScale = 0x1p-120; ///< its inverse, too, is in range

  Point at = {0.0f, 0.0f, 0.0f};
  float error = kInfinity, slack = kInfinity;
  float inverse_unit = 1.0f, inverse_below = 1.0f + 4 * kNeighborShare, above = 1.0f + 2 * kNeighborShare;
};

/// The float halfway in the order of floats >= 0, rounded down.
inline float halfwayUp(float low, float high)
{
  const auto below = std::bit_cast<std::uint32_t>(low), above = std::bit_cast<std::uint32_t>(high);
  return std::bit_cast<float>(below + (above - below) / 2);
}

static_assert(kSquaredDistanceError + 3 * kFloatUnit < kNeighborShare); // of a distance, a product and a sum

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
