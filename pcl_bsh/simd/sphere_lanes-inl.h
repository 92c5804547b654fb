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
#include <pcl_bsh/simd/supports.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

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

/// The limit of spheresNear(), of a radius and its stretch, and a reach that is a sum of another such radius and a
/// pruneReach(); squared, and times 1 + kSphereMargin.
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

/// Bit i: (x, y, z) is not proven to be farther than reaches[i] + more from the centre of sphere i; proven it is where
/// that sum is below 0. As nearLimit() has it, both rounded outward. @param gap as spheresNear() has it, or null
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

/// Bit i: from the centre of sphere i to that of another one it is more than `times` as far as both radii together.
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

/// A sphere's points between two planes: |normal . (p - center)| <= h.
struct Slab {
  Point normal;
  float h;
  Point center;
  float radius;
};

/// Eight normals, and how far from their planes points are at most.
struct SlabLanes {
  const float *x, *y, *z, *h;
};

/// The longest length that slabs are compared with: sums of its squares are in the range of float.
inline constexpr float kLongestOfSlabs = 0x1p60f;

/// A vector of slabs, from lane i on, and another one: what the bounds of their distance have in common. d is from the
/// other centre to those of the lanes.
///
/// Across a normal spheres are as wide as their radii, and d less its part along the normal errs by 2^-17 |d| and
/// rounding, which kSlabMargin pays for, too. The squares err as those of spheres do.
///
/// Along a normal u, another slab of normal n and sphere of radius r reaches as far as |u . n| h + |u - (u . n) n| r.
/// Here u is split into its components along n and across it. Normals may be off length 1 by 2^-19, and so may the
/// rotation that carries them between frames. kSlabMargin of all lengths pays for these and for float arithmetic, a few
/// roundings of each term. As much in the sine's square pays for those of 1 - cosine^2. A normal of 0 proves nothing.
/// Nothing is proven where squares may leave the range of float: triangles reach beyond the frame that holds their
/// middles.
struct FacingSlabs {
  HWY_INLINE FacingSlabs(LaneTag d, std::size_t i, const SphereLanes& spheres, const SlabLanes& slabs,
                         const Slab& other)
  : ux(hn::Set(d, other.normal.x)),
    uy(hn::Set(d, other.normal.y)),
    uz(hn::Set(d, other.normal.z)),
    nx(hn::LoadU(d, slabs.x + i)),
    ny(hn::LoadU(d, slabs.y + i)),
    nz(hn::LoadU(d, slabs.z + i)),
    dx(hn::Sub(hn::LoadU(d, spheres.x + i), hn::Set(d, other.center.x))),
    dy(hn::Sub(hn::LoadU(d, spheres.y + i), hn::Set(d, other.center.y))),
    dz(hn::Sub(hn::LoadU(d, spheres.z + i), hn::Set(d, other.center.z))),
    h(hn::LoadU(d, slabs.h + i)),
    r(hn::Mul(hn::LoadU(d, spheres.r + i), hn::Set(d, spheres.stretch))),
    other_h(hn::Set(d, other.h)),
    other_r(hn::Set(d, other.radius)),
    on_u(dot(ux, uy, uz, dx, dy, dz)),
    on_n(dot(nx, ny, nz, dx, dy, dz))
  {
    const LaneVector cosine = hn::Abs(dot(nx, ny, nz, ux, uy, uz));
    const LaneVector sine = hn::Sqrt(
        hn::Add(hn::Max(hn::Zero(d), hn::Sub(hn::Set(d, 1.0f), hn::Mul(cosine, cosine))), hn::Set(d, kSlabMargin)));
    const LaneVector along_other =
        hn::Sub(hn::Abs(on_u), hn::Add(other_h, hn::Add(hn::Mul(cosine, h), hn::Mul(sine, r))));
    const LaneVector along_own =
        hn::Sub(hn::Abs(on_n), hn::Add(h, hn::Add(hn::Mul(cosine, other_h), hn::Mul(sine, other_r))));
    by_own = hn::Gt(along_own, along_other);
    along = hn::Max(along_other, along_own);
  }

  static HWY_INLINE LaneVector dot(LaneVector ax, LaneVector ay, LaneVector az, LaneVector bx, LaneVector by,
                                   LaneVector bz)
  {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
  }

  /// |d| less its part `on` a normal.
  HWY_INLINE LaneVector rest(LaneVector on, LaneVector x, LaneVector y, LaneVector z) const
  {
    return hn::Sqrt(squaredNorm(hn::Sub(dx, hn::Mul(on, x)), hn::Sub(dy, hn::Mul(on, y)), hn::Sub(dz, hn::Mul(on, z))));
  }

  /// Squared distance from the gaps along the better of both normals and across it. @param rest across that normal
  HWY_INLINE LaneVector squared(LaneTag d, LaneVector rest) const
  {
    const LaneVector radii = hn::Add(r, other_r);
    const LaneVector lengths = hn::Add(hn::Add(hn::Add(hn::Abs(dx), hn::Abs(dy)), hn::Abs(dz)), radii);
    const LaneVector margin = hn::Mul(lengths, hn::Set(d, kSlabMargin));
    const LaneVector far_along = hn::Max(hn::Sub(along, margin), hn::Zero(d));
    const LaneVector across = hn::Max(hn::Sub(rest, hn::Add(radii, margin)), hn::Zero(d));
    const LaneVector sum = hn::Add(hn::Mul(far_along, far_along), hn::Mul(across, across));
    return hn::IfThenElseZero(hn::Lt(lengths, hn::Set(d, kLongestOfSlabs)), sum);
  }

  /// Between how far both reach along d. Underflow in a rest is far below the smallest length.
  HWY_INLINE LaneVector between(LaneTag d, LaneVector rest_u, LaneVector rest_n) const
  {
    const LaneVector length = hn::Sqrt(squaredNorm(dx, dy, dz));
    const LaneVector supports =
        hn::Add(supportTimesLength(d, on_u, other_h, rest_u, other_r), supportTimesLength(d, on_n, h, rest_n, r));
    return hn::Sub(hn::Sub(length, hn::Div(supports, length)), supportMargin(d, length, hn::Add(r, other_r)));
  }

  static HWY_INLINE LaneVector supportTimesLength(LaneTag d, LaneVector on, LaneVector h, LaneVector rest, LaneVector r)
  {
    return hn::Add(hn::Mul(hn::Abs(on), h), hn::Mul(hn::Max(rest, hn::Set(d, static_cast<float>(kSmallestLength))), r));
  }

  static HWY_INLINE LaneVector supportMargin(LaneTag d, LaneVector length, LaneVector radii)
  {
    return hn::Add(hn::Mul(radii, hn::Set(d, kSupportShare)), hn::Mul(length, hn::Set(d, kDistanceShare)));
  }

  LaneVector ux, uy, uz, nx, ny, nz, dx, dy, dz, h, r, other_h, other_r, on_u, on_n, along;
  hn::Mask<LaneTag> by_own; ///< along whose normals they are farther apart
};

/// Bit i: slab i, of sphere i, is proven to be more than reach away from another one: along the normal of either and
/// across it. For sheets that face each other at the reach, the distance across leaves only the records that lie
/// opposite.
HWY_INLINE std::uint32_t slabsApart(const SphereLanes& spheres, const SlabLanes& slabs, const Slab& other, float reach)
{
  const LaneTag d;
  const LaneVector limit = hn::Set(d, reach * reach * (1.0f + kSphereMargin) + kVanishingSquare);
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const FacingSlabs f(d, i, spheres, slabs, other);
    const LaneVector rest = f.rest(hn::IfThenElse(f.by_own, f.on_n, f.on_u), hn::IfThenElse(f.by_own, f.nx, f.ux),
                                   hn::IfThenElse(f.by_own, f.ny, f.uy), hn::IfThenElse(f.by_own, f.nz, f.uz));
    apart |= bitsOf(d, hn::Gt(f.squared(d, rest), limit)) << i;
  }
  return apart;
}

/// A lower bound of the gap between each slab and another one, in the frame: that of slabsApart(), or the gap along d
/// where it is larger. 0 where no gap is known.
HWY_INLINE void slabGaps(const SphereLanes& spheres, const SlabLanes& slabs, const Slab& other, float* gaps)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const FacingSlabs f(d, i, spheres, slabs, other);
    const LaneVector rest_u = f.rest(f.on_u, f.ux, f.uy, f.uz), rest_n = f.rest(f.on_n, f.nx, f.ny, f.nz);
    const LaneVector squared = f.squared(d, hn::IfThenElse(f.by_own, rest_n, rest_u));
    const LaneVector by_slabs = hn::Sqrt(hn::Max(hn::Sub(squared, hn::Set(d, kVanishingSquare)), hn::Zero(d)));
    const LaneVector between = f.between(d, rest_u, rest_n);
    const LaneVector gap = hn::IfThenElse(hn::Gt(between, by_slabs), between, by_slabs); // not so for NaN
    hn::StoreU(hn::IfThenElseZero(hn::IsFinite(gap), gap), d, gaps + i);                 // squares may overflow
  }
}

/// Bit i: a distance that was bounded in the frame, as by slabGaps(), is greater than reach.
HWY_INLINE std::uint32_t gapsBeyond(const float* gaps, float reach)
{
  const LaneTag d;
  std::uint32_t beyond = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d))
    beyond |= bitsOf(d, hn::Gt(hn::Mul(hn::LoadU(d, gaps + i), hn::Set(d, 1.0f - kSphereMargin)), hn::Set(d, reach)))
              << i;
  return beyond;
}

/// Two slabs of the same points, in one sphere.
struct CrossedSlabs {
  Point normal, cross;
  float h, cross_h;
  Point center;
  float radius;

  float thickness() const { return h > cross_h ? h : cross_h; }
};

/// slabGaps() by how far the points in two slabs each reach along d.
HWY_INLINE void supportGaps(const SphereLanes& spheres, const SlabLanes& slabs, const SlabLanes& cross_slabs,
                            const CrossedSlabs& other, float* gaps)
{
  const LaneTag d;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const LaneVector dx = hn::Sub(hn::LoadU(d, spheres.x + i), hn::Set(d, other.center.x));
    const LaneVector dy = hn::Sub(hn::LoadU(d, spheres.y + i), hn::Set(d, other.center.y));
    const LaneVector dz = hn::Sub(hn::LoadU(d, spheres.z + i), hn::Set(d, other.center.z));
    const auto supportOf = [&](LaneVector nx, LaneVector ny, LaneVector nz, LaneVector h, LaneVector cx, LaneVector cy,
                               LaneVector cz, LaneVector cross_h, LaneVector r) HWY_ATTR {
      const LaneVector on_n = FacingSlabs::dot(nx, ny, nz, dx, dy, dz);
      const LaneVector on_c = FacingSlabs::dot(cx, cy, cz, dx, dy, dz);
      const auto less = [&](LaneVector all, LaneVector n, LaneVector c)
                            HWY_ATTR { return hn::Sub(hn::Sub(all, hn::Mul(on_n, n)), hn::Mul(on_c, c)); };
      const LaneVector rest = hn::Sqrt(squaredNorm(less(dx, nx, cx), less(dy, ny, cy), less(dz, nz, cz)));
      return hn::Add(hn::Mul(hn::Abs(on_c), cross_h), FacingSlabs::supportTimesLength(d, on_n, h, rest, r));
    };
    const LaneVector r = hn::Mul(hn::LoadU(d, spheres.r + i), hn::Set(d, spheres.stretch));
    const LaneVector own =
        supportOf(hn::LoadU(d, slabs.x + i), hn::LoadU(d, slabs.y + i), hn::LoadU(d, slabs.z + i),
                  hn::LoadU(d, slabs.h + i), hn::LoadU(d, cross_slabs.x + i), hn::LoadU(d, cross_slabs.y + i),
                  hn::LoadU(d, cross_slabs.z + i), hn::LoadU(d, cross_slabs.h + i), r);
    const LaneVector others =
        supportOf(hn::Set(d, other.normal.x), hn::Set(d, other.normal.y), hn::Set(d, other.normal.z),
                  hn::Set(d, other.h), hn::Set(d, other.cross.x), hn::Set(d, other.cross.y), hn::Set(d, other.cross.z),
                  hn::Set(d, other.cross_h), hn::Set(d, other.radius));
    const LaneVector length = hn::Sqrt(squaredNorm(dx, dy, dz));
    const LaneVector margin = FacingSlabs::supportMargin(d, length, hn::Add(r, hn::Set(d, other.radius)));
    const LaneVector gap = hn::Sub(hn::Sub(length, hn::Div(hn::Add(own, others), length)), margin);
    hn::StoreU(hn::IfThenElseZero(hn::IsFinite(gap), gap), d, gaps + i);
  }
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

/// Raises all values to `least`. Bit i: it is `floor` or less even so.
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

/// The first of them.
HWY_INLINE std::uint32_t smallestLane(const float* values, std::uint32_t among)
{
  return static_cast<std::uint32_t>(std::countr_zero(smallestLanes(values, among)));
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle
