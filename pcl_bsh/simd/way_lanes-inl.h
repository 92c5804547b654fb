// SPDX-License-Identifier: BSD-3-Clause
// A leaf's points that all go the same short way, against a point.

#if defined(PCL_BSH_SIMD_WAY_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_WAY_LANES_INL_H_
#undef PCL_BSH_SIMD_WAY_LANES_INL_H_
#else
#define PCL_BSH_SIMD_WAY_LANES_INL_H_
#endif

#include <pcl_bsh/simd/point_lanes-inl.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A straight way that all points go, each from its place.
struct PointsWay {
  float x = 0.0f, y = 0.0f, z = 0.0f;
  float per_square = 0.0f; ///< 1 over the square of its length, or 0: then points stay where they are
};

/// Which of sixteen points do not stay, on all of their way, farther than a squared distance from (qx, qy, qz).
/// Rounding moves the nearest place of a way along this way only.
HWY_INLINE std::uint32_t pointsPassing(const LeafPoints& points, const PointsWay& way, float qx, float qy, float qz,
                                       float squared_limit)
{
  const LaneTag d;
  const LaneVector wx = hn::Set(d, way.x), wy = hn::Set(d, way.y), wz = hn::Set(d, way.z);
  const LaneVector limit = hn::Set(d, squared_limit);
  std::uint32_t far = 0;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
    const LaneVector dx = hn::Sub(hn::Load(d, points.x + i), hn::Set(d, qx));
    const LaneVector dy = hn::Sub(hn::Load(d, points.y + i), hn::Set(d, qy));
    const LaneVector dz = hn::Sub(hn::Load(d, points.z + i), hn::Set(d, qz));
    const LaneVector back = hn::Mul(FacingSlabs::dot(wx, wy, wz, dx, dy, dz), hn::Set(d, way.per_square));
    const LaneVector share = hn::Min(hn::Max(back, hn::Set(d, -1.0f)), hn::Zero(d));
    const LaneVector squared =
        squaredNorm(hn::Sub(dx, hn::Mul(share, wx)), hn::Sub(dy, hn::Mul(share, wy)), hn::Sub(dz, hn::Mul(share, wz)));
    far |= bitsOf(d, hn::Gt(squared, limit)) << i;
  }
  return ~far & firstBits(kLeafPoints);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
