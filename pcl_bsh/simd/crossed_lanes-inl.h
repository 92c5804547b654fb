// SPDX-License-Identifier: BSD-3-Clause
// Records that lie both in a sphere and in two slabs, against others like them and against points. Long triangles side
// by side lie so: their sphere is as large as one of them is long.

#if defined(PCL_BSH_SIMD_CROSSED_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_SIMD_CROSSED_LANES_INL_H_
#undef PCL_BSH_SIMD_CROSSED_LANES_INL_H_
#else
#define PCL_BSH_SIMD_CROSSED_LANES_INL_H_
#endif

#include <pcl_bsh/simd/point_lanes-inl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Lower bounds of squared distances to anything that lies in both slabs. @param dx, dy, dz from their centre
/// @param margin kSlabMargin of all lengths, as FacingSlabs has it
///
/// A vector v from a place into both slabs has components of at least g and k along the normals n and c. These need not
/// be square to each other. Let m = |n . c|. Then |v|^2 >= (g^2 + k^2 - 2 m g k) / (1 - m^2) >= (1 - m) (g^2 + k^2).
/// The cosine and the squares lose less than 2^-16 in float arithmetic.
HWY_INLINE LaneVector squaredToSlabs(const CrossedSlabs& held, LaneVector dx, LaneVector dy, LaneVector dz,
                                     LaneVector margin)
{
  const LaneTag d;
  const auto gap = [&](const Point& normal, float h) HWY_ATTR {
    const LaneVector on =
        FacingSlabs::dot(hn::Set(d, normal.x), hn::Set(d, normal.y), hn::Set(d, normal.z), dx, dy, dz);
    const LaneVector beyond = hn::Sub(hn::Sub(hn::Abs(on), margin), hn::Set(d, h * (1.0f + kSphereMargin)));
    return hn::Max(beyond, hn::Zero(d));
  };
  const Point &n = held.normal, &c = held.cross;
  const float share = std::max(1.0f - 0x1p-16f - std::abs(n.x * c.x + n.y * c.y + n.z * c.z), 0.0f);
  const LaneVector g = gap(n, held.h), k = gap(c, held.cross_h), more = hn::Max(g, k);
  return hn::Max(hn::Mul(hn::Add(hn::Mul(g, g), hn::Mul(k, k)), hn::Set(d, share)), hn::Mul(more, more));
}

/// Which of a leaf's `count` points are not proven to be farther than reach from what lies both in a sphere and in two
/// slabs; sixteen are read.
HWY_INLINE std::uint32_t pointsNearSlabs(const float* x, const float* y, const float* z, std::size_t count,
                                         const CrossedSlabs& held, float reach)
{
  const LaneTag d;
  const LaneVector radius = hn::Set(d, held.radius),
                   limit = hn::Set(d, reach * reach * (1.0f + 4 * kSphereMargin) + kVanishingSquare);
  std::uint32_t far = 0;
  for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
    const LaneVector dx = hn::Sub(hn::LoadU(d, x + i), hn::Set(d, held.center.x));
    const LaneVector dy = hn::Sub(hn::LoadU(d, y + i), hn::Set(d, held.center.y));
    const LaneVector dz = hn::Sub(hn::LoadU(d, z + i), hn::Set(d, held.center.z));
    const LaneVector lengths = hn::Add(hn::Add(hn::Add(hn::Abs(dx), hn::Abs(dy)), hn::Abs(dz)), radius);
    const auto apart = hn::Gt(squaredToSlabs(held, dx, dy, dz, hn::Mul(lengths, hn::Set(d, kSlabMargin))), limit);
    far |= bitsOf(d, hn::And(apart, hn::Lt(lengths, hn::Set(d, kLongestOfSlabs)))) << i;
  }
  return ~far & firstBits(count);
}

/// Bit i: the records in sphere i and its two slabs are proven to be more than reach away from the other's. The proof
/// is along a normal of either, or across the directions in which both are longest.
///
/// The gap along any direction u is a lower bound; it is measured in units of |u|. A part of u along a normal reaches
/// as far as its slab, the rest as far as the sphere (NodeSupport). Normals of 0 prove nothing, and leave all to the
/// sphere. kSlabMargin of all lengths pays for the errors of normals, as in FacingSlabs, and for float arithmetic. The
/// rest of u errs by 8 roundings of it, a product with u by 4.
HWY_INLINE std::uint32_t crossedSlabsApart(const SphereLanes& spheres, const SlabLanes& slabs,
                                           const SlabLanes& cross_slabs, const CrossedSlabs& other, float reach)
{
  struct Vector3 {
    LaneVector x, y, z;
  };
  const LaneTag d;
  const auto spread = [d](const Point& p) HWY_ATTR {
    return Vector3{hn::Set(d, p.x), hn::Set(d, p.y), hn::Set(d, p.z)};
  };
  const auto dot = [](const Vector3& a, const Vector3& b)
                       HWY_ATTR { return FacingSlabs::dot(a.x, a.y, a.z, b.x, b.y, b.z); };
  const auto across = [](const Vector3& a, const Vector3& b) HWY_ATTR {
    return Vector3{hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
                   hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
  };
  const Vector3 other_normal = spread(other.normal), other_cross = spread(other.cross);
  const LaneVector other_h = hn::Set(d, other.h), other_cross_h = hn::Set(d, other.cross_h),
                   other_r = hn::Set(d, other.radius);
  std::uint32_t apart = 0;
  for (std::size_t i = 0; i < kLanes; i += hn::Lanes(d)) {
    const auto load = [&](const SlabLanes& of) HWY_ATTR {
      return Vector3{hn::LoadU(d, of.x + i), hn::LoadU(d, of.y + i), hn::LoadU(d, of.z + i)};
    };
    const Vector3 normal = load(slabs), cross = load(cross_slabs);
    const LaneVector h = hn::LoadU(d, slabs.h + i), cross_h = hn::LoadU(d, cross_slabs.h + i);
    const LaneVector r = hn::Mul(hn::LoadU(d, spheres.r + i), hn::Set(d, spheres.stretch));
    const Vector3 between{hn::Sub(hn::LoadU(d, spheres.x + i), hn::Set(d, other.center.x)),
                          hn::Sub(hn::LoadU(d, spheres.y + i), hn::Set(d, other.center.y)),
                          hn::Sub(hn::LoadU(d, spheres.z + i), hn::Set(d, other.center.z))};
    const LaneVector lengths =
        hn::Add(hn::Add(hn::Add(hn::Abs(between.x), hn::Abs(between.y)), hn::Abs(between.z)), hn::Add(r, other_r));
    const LaneVector least =
        hn::Add(hn::Set(d, reach * (1.0f + kSphereMargin)), hn::Mul(lengths, hn::Set(d, kSlabMargin)));
    const auto support = [&](const Vector3& u, const Vector3& n, const Vector3& c, LaneVector of_n, LaneVector of_c,
                             LaneVector of_rest) HWY_ATTR {
      const LaneVector on_n = dot(u, n), on_c = dot(u, c);
      const auto less = [&](LaneVector all, LaneVector nk, LaneVector ck)
                            HWY_ATTR { return hn::Sub(hn::Sub(all, hn::Mul(on_n, nk)), hn::Mul(on_c, ck)); };
      const LaneVector rest = hn::Sqrt(squaredNorm(less(u.x, n.x, c.x), less(u.y, n.y, c.y), less(u.z, n.z, c.z)));
      return hn::Add(hn::Add(hn::Mul(hn::Abs(on_n), of_n), hn::Mul(hn::Abs(on_c), of_c)), hn::Mul(rest, of_rest));
    };
    auto proven = hn::Lt(h, h);
    const auto tell = [&](const Vector3& u) HWY_ATTR {
      const LaneVector both = hn::Add(support(u, normal, cross, h, cross_h, r),
                                      support(u, other_normal, other_cross, other_h, other_cross_h, other_r));
      const LaneVector square = squaredNorm(u.x, u.y, u.z);
      const auto beyond = hn::Gt(hn::Sub(hn::Abs(dot(u, between)), both), hn::Mul(least, hn::Sqrt(square)));
      proven = hn::Or(proven, hn::And(beyond, hn::Gt(square, hn::Set(d, 0x1p-40f))));
    };
    tell(other_cross);
    tell(cross);
    tell(normal);
    tell(other_normal);
    tell(across(across(normal, cross), across(other_normal, other_cross)));
    apart |= bitsOf(d, hn::And(proven, hn::Lt(lengths, hn::Set(d, kLongestOfSlabs)))) << i;
  }
  return apart;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
