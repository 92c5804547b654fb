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

#include <pcl_bsh/simd/roundings.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::size_t kLanes = 8; ///< children of a node

using LaneTag = hn::CappedTag<float, kLanes>;
using LaneVector = hn::Vec<LaneTag>;

/// Bit i of the result: lane i of the mask.
template <class Mask>
HWY_INLINE std::uint32_t bitsOf(LaneTag d, Mask mask)
{
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}

HWY_INLINE float Add(float a, float b)
{
  return a + b;
}
HWY_INLINE float Mul(float a, float b)
{
  return a * b;
}

/// x^2 + y^2 + z^2, of floats, vectors of them, or Roundings.
template <class Number>
HWY_INLINE constexpr Number squaredNorm(Number x, Number y, Number z)
{
  return Add(Add(Mul(x, x), Mul(y, y)), Mul(z, z));
}

static_assert(squaredNorm(Roundings{1}, Roundings{1}, Roundings{1}) == Roundings{kSquaredDistanceRoundings},
              "of differences, rounded once: the bounds of squared distances follow from it");

/// row . (x, y, z) + shift, of floats, vectors of them, or Roundings.
template <class Number>
HWY_INLINE constexpr Number affine(Number shift, Number rx, Number ry, Number rz, Number x, Number y, Number z)
{
  return Add(Add(Add(shift, Mul(rx, x)), Mul(ry, y)), Mul(rz, z));
}

/// With the matrix and the shift rounded to float, and points as they are stored.
static_assert(affine(kNoTerm, Roundings{1}, Roundings{1}, Roundings{1}, Roundings{}, Roundings{}, Roundings{}) ==
                  Roundings{kCarriedProductRoundings},
              "the bounds of carried points follow from it");
static_assert(affine(Roundings{1}, kNoTerm, kNoTerm, kNoTerm, Roundings{}, Roundings{}, Roundings{}) ==
                  Roundings{kCarriedShiftRoundings},
              "the bounds of carried points follow from it");

/// One row of a transformation, each number spread over all lanes: row . (x, y, z) + shift.
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
    return affine(shift, rx, ry, rz, x, y, z);
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

/// The shift of directions.
inline constexpr float kNowhere[3] = {0.0f, 0.0f, 0.0f};

/// One point by y = m x + g, rounded as carry() rounds.
struct Point {
  float x, y, z;
};

HWY_INLINE Point carryPoint(const float* m, const float* g, const Point& p)
{
  return {affine(g[0], m[0], m[1], m[2], p.x, p.y, p.z), affine(g[1], m[3], m[4], m[5], p.x, p.y, p.z),
          affine(g[2], m[6], m[7], m[8], p.x, p.y, p.z)};
}

/// Eight spheres, and a factor that their radii are stretched by.
struct SphereLanes {
  const float *x, *y, *z, *r;
  float stretch;
};

/// The ball that spheres are tested against: its radius is part of the reaches.
struct QueryBall {
  float x, y, z;
  float near_reach;   ///< the clearance and the radius, rounded outward
  float inside_reach; ///< the clearance less the radius, rounded inward
};

/// The squared limit of spheresNear(): (radius + reach)^2 times `margin`, which is 1 + kSphereMargin. The radius is
/// stretched. The reach is the sum of another stretched radius and a pruneReach().
template <class Number>
HWY_INLINE constexpr Number nearLimit(Number radius, Number reach, Number margin)
{
  const Number sum = Add(radius, reach);
  return Mul(Mul(sum, sum), margin);
}

static_assert(nearLimit(Roundings{1}, Add(Roundings{1}, kNoTerm), Roundings{}) == Roundings{kSphereLimitRoundings},
              "the margin of spheres follows from it");
static_assert(relativeError(kSphereLimitRoundings) + kSquaredDistanceError < kSphereMargin);

/// Bit i: sphere i lies within inside_reach altogether.
HWY_INLINE std::uint32_t spheresInside(const SphereLanes& spheres, const QueryBall& ball)
{
  if (!(ball.inside_reach > 0.0f)) return 0;
  const LaneTag d;
  std::uint32_t inside = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector s = squaredNorm(hn::Sub(hn::LoadU(d, spheres.x + i), hn::Set(d, ball.x)),
                                     hn::Sub(hn::LoadU(d, spheres.y + i), hn::Set(d, ball.y)),
                                     hn::Sub(hn::LoadU(d, spheres.z + i), hn::Set(d, ball.z)));
    const LaneVector radius =
        hn::Mul(hn::LoadU(d, spheres.r + i), hn::Set(d, spheres.stretch * (1.0f + kSphereMargin)));
    const LaneVector room = hn::Sub(hn::Set(d, ball.inside_reach), radius);
    const LaneVector core =
        hn::Sub(hn::Mul(hn::Mul(room, room), hn::Set(d, 1.0f - kSphereMargin)), hn::Set(d, kVanishingSquare));
    inside |= bitsOf(d, hn::And(hn::Gt(room, hn::Zero(d)), hn::Le(s, core))) << i;
  }
  return inside;
}

/// Bit i: sphere i is not proven to be out of near_reach. @param gap receives an order of nearness, smaller is nearer;
/// or null.
HWY_INLINE std::uint32_t spheresNear(const SphereLanes& spheres, const QueryBall& ball, float* gap)
{
  const LaneTag d;
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector s = squaredNorm(hn::Sub(hn::LoadU(d, spheres.x + i), hn::Set(d, ball.x)),
                                     hn::Sub(hn::LoadU(d, spheres.y + i), hn::Set(d, ball.y)),
                                     hn::Sub(hn::LoadU(d, spheres.z + i), hn::Set(d, ball.z)));
    const LaneVector radius = hn::Mul(hn::LoadU(d, spheres.r + i), hn::Set(d, spheres.stretch));
    const LaneVector limit = nearLimit(radius, hn::Set(d, ball.near_reach), hn::Set(d, 1.0f + kSphereMargin));
    apart |= bitsOf(d, hn::Gt(s, limit)) << i; // not so for NaN, which counts as near
    if (gap) hn::StoreU(hn::Sub(hn::Sqrt(s), radius), d, gap + i);
  }
  return apart ^ ((1u << kLanes) - 1);
}

/// The points within `half` of a centre along each axis, in the frame of spheres that it is compared with.
struct QueryBox {
  Point center;
  float half[3];
};

/// Bit i: sphere i is not proven to be farther than `reach` from the box. As nearLimit() has it; the margins of the
/// centre's distance and of the box pay for the rounding of differences.
HWY_INLINE std::uint32_t spheresNearBox(const SphereLanes& spheres, const QueryBox& box, float reach)
{
  const LaneTag d;
  const auto beside = [d](const float* places, float at, float half) HWY_ATTR {
    const LaneVector away = hn::Abs(hn::Sub(hn::LoadU(d, places), hn::Set(d, at)));
    const LaneVector less = hn::Set(d, 1.0f - kSphereMargin);
    return hn::Max(hn::Sub(hn::Mul(away, less), hn::Set(d, half * (1.0f + kSphereMargin))), hn::Zero(d));
  };
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector s =
        squaredNorm(beside(spheres.x + i, box.center.x, box.half[0]), beside(spheres.y + i, box.center.y, box.half[1]),
                    beside(spheres.z + i, box.center.z, box.half[2]));
    const LaneVector radius = hn::Mul(hn::LoadU(d, spheres.r + i), hn::Set(d, spheres.stretch));
    apart |= bitsOf(d, hn::Gt(s, nearLimit(radius, hn::Set(d, reach), hn::Set(d, 1.0f + kSphereMargin)))) << i;
  }
  return apart ^ ((1u << kLanes) - 1);
}

/// Bit i: (x, y, z) is not proven to be farther than reaches[i] + more from the centre of sphere i; a sum below 0
/// counts as proof. As nearLimit() has it, both rounded outward. @param gap as spheresNear() has it, or null
HWY_INLINE std::uint32_t spheresNearEach(const SphereLanes& spheres, const float* reaches, const Point& to, float more,
                                         float* gap)
{
  const LaneTag d;
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector s = squaredNorm(hn::Sub(hn::LoadU(d, spheres.x + i), hn::Set(d, to.x)),
                                     hn::Sub(hn::LoadU(d, spheres.y + i), hn::Set(d, to.y)),
                                     hn::Sub(hn::LoadU(d, spheres.z + i), hn::Set(d, to.z)));
    const LaneVector reach = hn::LoadU(d, reaches + i), sum = hn::Add(reach, hn::Set(d, more));
    const LaneVector limit = nearLimit(reach, hn::Set(d, more), hn::Set(d, 1.0f + kSphereMargin));
    apart |= bitsOf(d, hn::Or(hn::Gt(s, limit), hn::Lt(sum, hn::Zero(d)))) << i; // not so for NaN
    if (gap) hn::StoreU(hn::Sub(hn::Sqrt(s), reach), d, gap + i);
  }
  return apart ^ ((1u << kLanes) - 1);
}

/// Bit i: the centres of sphere i and of another sphere are more than `times` the sum of both radii apart.
/// @param gap as spheresNear() gave it. @param radius of the other one
HWY_INLINE std::uint32_t spheresFar(const float* gap, const float* radii, float stretch, float radius, float times)
{
  const LaneTag d;
  std::uint32_t far = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector own = hn::Mul(hn::LoadU(d, radii + i), hn::Set(d, (times - 1.0f) * stretch));
    far |= bitsOf(d, hn::Gt(hn::LoadU(d, gap + i), hn::Add(own, hn::Set(d, times * radius)))) << i;
  }
  return far;
}

/// Squared distances of the eight centres to a point.
HWY_INLINE void centersSquared(const SphereLanes& spheres, const Point& point, float* squared)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    hn::Store(squaredNorm(hn::Sub(hn::LoadU(d, spheres.x + i), hn::Set(d, point.x)),
                          hn::Sub(hn::LoadU(d, spheres.y + i), hn::Set(d, point.y)),
                          hn::Sub(hn::LoadU(d, spheres.z + i), hn::Set(d, point.z))),
              d, squared + i);
}

/// spheresNear(), where the squared distances of the centres are known; `reach` is what near_reach is there.
HWY_INLINE std::uint32_t spheresNear(const float* squared, const float* radii, float reach)
{
  const LaneTag d;
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector limit = nearLimit(hn::LoadU(d, radii + i), hn::Set(d, reach), hn::Set(d, 1.0f + kSphereMargin));
    apart |= bitsOf(d, hn::Gt(hn::Load(d, squared + i), limit)) << i;
  }
  return apart ^ ((1u << kLanes) - 1);
}

/// Raises values below `least` to it. Bit i: the raised value is still at most `floor`.
HWY_INLINE std::uint32_t raiseLanes(float* values, float least, float floor)
{
  const LaneTag d;
  std::uint32_t low = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector raised = hn::Max(hn::Load(d, values + i), hn::Set(d, least));
    hn::Store(raised, d, values + i);
    low |= bitsOf(d, hn::Le(raised, hn::Set(d, floor))) << i;
  }
  return low;
}

/// Bit i: the value is below the limit.
HWY_INLINE std::uint32_t lanesBelow(const float* values, float limit)
{
  const LaneTag d;
  std::uint32_t below = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    below |= bitsOf(d, hn::Lt(hn::Load(d, values + i), hn::Set(d, limit))) << i;
  return below;
}

/// The lanes of the smallest value among those with their bit set, of which there is at least one.
HWY_INLINE std::uint32_t smallestLanes(const float* values, std::uint32_t among)
{
  const LaneTag d;
  LaneVector best = hn::Set(d, std::numeric_limits<float>::infinity());
  alignas(32) float candidate[kLanes];
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(among >> i)};
    const LaneVector value = hn::IfThenElse(hn::LoadMaskBits(d, bits), hn::Load(d, values + i),
                                            hn::Set(d, std::numeric_limits<float>::infinity()));
    hn::Store(value, d, candidate + i);
    best = hn::Min(best, value);
  }
  best = hn::MinOfLanes(d, best);
  std::uint32_t lanes = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    lanes |= bitsOf(d, hn::Eq(hn::Load(d, candidate + i), best)) << i;
  lanes &= among;
  return lanes != 0 ? lanes : among; // NaN and infinity: any
}

/// The first lane of smallestLanes().
HWY_INLINE std::uint32_t smallestLane(const float* values, std::uint32_t among)
{
  return static_cast<std::uint32_t>(std::countr_zero(smallestLanes(values, among)));
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
