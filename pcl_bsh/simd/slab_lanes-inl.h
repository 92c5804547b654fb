// SPDX-License-Identifier: BSD-3-Clause
// Eight slabs against one: lower bounds of how far the points between their planes are apart.

#if defined(PCL_BSH_SIMD_SLAB_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_SLAB_LANES_INL_H_
#undef PCL_BSH_SIMD_SLAB_LANES_INL_H_
#else
#define PCL_BSH_SIMD_SLAB_LANES_INL_H_
#endif

#include <pcl_bsh/simd/sphere_lanes-inl.h>
#include <pcl_bsh/simd/supports.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

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

/// The slabs of one vector, from lane i on, against another slab: values that all bounds of their distance use. d is
/// the vector from the other centre to the centre of each lane.
///
/// Across a normal spheres are as wide as their radii, and d less its part along the normal errs by 2^-17 |d| and
/// rounding, which kSlabMargin pays for, too. The squares err as those of spheres do.
///
/// Along a normal u, another slab of normal n and sphere of radius r reaches as far as |u . n| h + |u - (u . n) n| r.
/// Here u is split into its components along n and across it. Normals may be off length 1 by 2^-19, and so may the
/// rotation that carries them between frames. kSlabMargin of all lengths pays for these and for float arithmetic, a few
/// roundings of each term. As much, kSlabMargin, in the sine's square pays for the roundings of 1 - cosine^2. A normal
/// of 0 proves nothing. Nothing is proven where squares may leave the range of float: triangles reach beyond the frame
/// that holds their middles.
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

  /// The length of d without its part `on` along a normal (x, y, z).
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

  /// A lower bound of the gap along d between the points of both. Underflow in a rest is far below the smallest length.
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
  hn::Mask<LaneTag> by_own; ///< they are farther apart along the lane's normal than along the other one
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

/// slabGaps() for points in two slabs each: lower bounds of the gap along d between the points of both.
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

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
