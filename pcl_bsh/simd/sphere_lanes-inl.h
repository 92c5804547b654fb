// SPDX-License-Identifier: BSD-3-Clause
// Eight spheres against one, in one go. Compiled once per instruction set (Highway), like everything named -inl.h here.
//
// Products are never fused into sums here: the walk, its counters and its order are the same on every instruction set.

#if defined(PCL_BSH_SIMD_SPHERE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_SPHERE_LANES_INL_H_
#undef PCL_BSH_SIMD_SPHERE_LANES_INL_H_
#else
#define PCL_BSH_SIMD_SPHERE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::size_t kLanes = 8; ///< children of a node

using LaneTag = hn::CappedTag<float, kLanes>;
using LaneVector = hn::Vec<LaneTag>;

/// Bit i of the result: lane (first + i) of the mask.
template <class Mask>
HWY_INLINE std::uint32_t bitsOf(LaneTag d, Mask mask)
{
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}

/// x^2 + y^2 + z^2.
HWY_INLINE LaneVector squaredNorm(LaneVector x, LaneVector y, LaneVector z)
{
  return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
}

/// The columns of one row of a transformation, spread over lanes: row . (x, y, z) + shift.
struct AffineRow {
  LaneVector rx, ry, rz, shift;

  HWY_INLINE AffineRow(LaneTag d, const float* row, float offset)
  : rx(hn::Set(d, row[0])),
    ry(hn::Set(d, row[1])),
    rz(hn::Set(d, row[2])),
    shift(hn::Set(d, offset))
  {
  }

  HWY_INLINE LaneVector operator()(LaneVector x, LaneVector y, LaneVector z) const
  {
    return hn::Add(hn::Add(hn::Add(shift, hn::Mul(rx, x)), hn::Mul(ry, y)), hn::Mul(rz, z));
  }
};

/// Carries `count` points (rounded up to whole vectors; the arrays reach that far) by y = m x + g.
/// @param m 9 floats, row-major. @param g 3 floats.
HWY_INLINE void carry(const float* m, const float* g, const float* x, const float* y, const float* z, std::size_t count,
                      float* out_x, float* out_y, float* out_z)
{
  const LaneTag d;
  const AffineRow row_x(d, m, g[0]), row_y(d, m + 3, g[1]), row_z(d, m + 6, g[2]);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const LaneVector vx = hn::LoadU(d, x + i), vy = hn::LoadU(d, y + i), vz = hn::LoadU(d, z + i);
    hn::StoreU(row_x(vx, vy, vz), d, out_x + i);
    hn::StoreU(row_y(vx, vy, vz), d, out_y + i);
    hn::StoreU(row_z(vx, vy, vz), d, out_z + i);
  }
}

/// Which of eight spheres may hold a point within reach of a ball, and which surely hold only such points.
struct SphereHits {
  std::uint32_t near = 0;   ///< bit i: sphere i is not proven to be apart
  std::uint32_t inside = 0; ///< bit i: every point of sphere i is within reach of every point of the ball
};

/// @param x,y,z,r eight spheres. @param stretch multiplies r. @param cx,cy,cz the ball's centre; `near_reach` its
/// radius and the clearance, rounded outward; `inside_reach` the clearance less its radius, rounded inward. @param
/// margin relative margin of squared comparisons. @param gap receives squared distance less squared sum of radii: an
/// order of nearness.
HWY_INLINE SphereHits testSpheres(const float* x, const float* y, const float* z, const float* r, float stretch,
                                  float cx, float cy, float cz, float near_reach, float inside_reach, float margin,
                                  float* gap)
{
  const LaneTag d;
  SphereHits hits;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector dx = hn::Sub(hn::LoadU(d, x + i), hn::Set(d, cx));
    const LaneVector dy = hn::Sub(hn::LoadU(d, y + i), hn::Set(d, cy));
    const LaneVector dz = hn::Sub(hn::LoadU(d, z + i), hn::Set(d, cz));
    const LaneVector s = squaredNorm(dx, dy, dz);
    const LaneVector radius = hn::Mul(hn::LoadU(d, r + i), hn::Set(d, stretch));
    const LaneVector reach = hn::Add(radius, hn::Set(d, near_reach));
    const LaneVector limit = hn::Mul(hn::Mul(reach, reach), hn::Set(d, 1.0f + margin));
    hits.near |= (bitsOf(d, hn::Gt(s, limit)) ^ ((1u << hn::Lanes(d)) - 1)) << i; // NaN counts as near
    hn::StoreU(hn::Sub(s, limit), d, gap + i);
    const LaneVector room = hn::Sub(hn::Set(d, inside_reach), hn::Mul(radius, hn::Set(d, 1.0f + margin)));
    const LaneVector core = hn::Sub(hn::Mul(hn::Mul(room, room), hn::Set(d, 1.0f - margin)), hn::Set(d, 0x1p-120f));
    hits.inside |= bitsOf(d, hn::And(hn::Gt(room, hn::Zero(d)), hn::Le(s, core))) << i;
  }
  return hits;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
