// SPDX-License-Identifier: BSD-3-Clause
#include "kernels.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "test/geometry/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/simd/segment_lanes-inl.h>
#include <pcl_bsh/simd/slab_lanes-inl.h>
#include <pcl_bsh/simd/triangle_lanes-inl.h>
#include <pcl_bsh/simd/triangle_pair_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// The lane of eight that is looked at; the others hold other numbers.
constexpr std::size_t kLane = 5;

void setLane(float* lanes, float value)
{
  for (std::size_t i = 0; i < 8; ++i) lanes[i] = i == kLane ? value : value + 1.0f + static_cast<float>(i);
}

void carryOnTarget(const float* m, const float* g, const float* x, const float* y, const float* z, test::Carried& out)
{
  carry(m, g, x, y, z, 8, out.x, out.y, out.z);
  const Point p = carryPoint(m, g, {x[0], y[0], z[0]});
  out.point[0] = p.x, out.point[1] = p.y, out.point[2] = p.z;
}

void squaredOnTarget(const float* x, const float* y, const float* z, const float* to, float* squared)
{
  const float no_radii[8] = {};
  centersSquared({x, y, z, no_radii, 1.0f}, {to[0], to[1], to[2]}, squared);
}

test::Near testOnTarget(const float* center, const float* radius_stretch, const float* ball, float ball_radius,
                        const float* reaches)
{
  alignas(32) float x[8], y[8], z[8], r[8];
  setLane(x, center[0]);
  setLane(y, center[1]);
  setLane(z, center[2]);
  setLane(r, radius_stretch[0]);
  const SphereLanes spheres{x, y, z, r, radius_stretch[1]};
  const QueryBall held{ball[0], ball[1], ball[2], ball_radius + reaches[0],
                       reaches[1] - ball_radius * (1.0f + kSphereMargin)};
  return {(spheresNear(spheres, held, nullptr) >> kLane & 1) != 0, (spheresInside(spheres, held) >> kLane & 1) != 0};
}

bool slabsApartOnTarget(const test::TestSlab& slab, float stretch, const test::TestSlab& other, float reach)
{
  alignas(32) float at[8][8];
  const float values[8] = {slab.center[0], slab.center[1], slab.center[2], slab.radius,
                           slab.normal[0], slab.normal[1], slab.normal[2], slab.h};
  for (std::size_t k = 0; k < 8; ++k) setLane(at[k], values[k]);
  const Slab held{{other.normal[0], other.normal[1], other.normal[2]},
                  other.h,
                  {other.center[0], other.center[1], other.center[2]},
                  other.radius};
  const std::uint32_t apart =
      slabsApart({at[0], at[1], at[2], at[3], stretch}, {at[4], at[5], at[6], at[7]}, held, reach);
  return (apart >> kLane & 1) != 0;
}

test::Gaps gapsOnTarget(const test::TestSlab& slab, const test::TestSlab& cross, float stretch,
                        const test::TestSlab& other, const test::TestSlab& other_cross)
{
  alignas(64) float at[12][16];
  const float values[12] = {slab.center[0],  slab.center[1],  slab.center[2],  slab.radius,
                            slab.normal[0],  slab.normal[1],  slab.normal[2],  slab.h,
                            cross.normal[0], cross.normal[1], cross.normal[2], cross.h};
  for (std::size_t k = 0; k < 12; ++k) setLane(at[k], values[k]);
  const auto pointOf = [](const float(&v)[3]) { return Point{v[0], v[1], v[2]}; };
  const SphereLanes spheres{at[0], at[1], at[2], at[3], stretch};
  const SlabLanes slabs{at[4], at[5], at[6], at[7]}, crossed{at[8], at[9], at[10], at[11]};
  alignas(32) float by_slabs[8], by_supports[8];
  slabGaps(spheres, slabs, {pointOf(other.normal), other.h, pointOf(other.center), other.radius}, by_slabs);
  supportGaps(
      spheres, slabs, crossed,
      {pointOf(other.normal), pointOf(other_cross.normal), other.h, other_cross.h, pointOf(other.center), other.radius},
      by_supports);
  for (std::size_t k = 0; k < 3; ++k) std::fill(at[k], at[k] + 16, other.center[k]);
  const float to_points =
      pointsGap(at[0], at[1], at[2], 11, {pointOf(slab.normal), slab.h, pointOf(slab.center), slab.radius * stretch});
  return {by_slabs[kLane], by_supports[kLane], to_points};
}

test::Stay segmentInBoxOnTarget(const float* start, const float* end, const float* bow, float smallest, float reach,
                                const float* low, const float* high)
{
  alignas(64) float from[3][8], to[3][8], bows[3][8];
  for (std::size_t k = 0; k < 3; ++k) {
    setLane(bows[k], bow[k]);
    setLane(from[k], start[k]);
    setLane(to[k], end[k]);
  }
  Segments<8> segments;
  segments.set(from, to, bows, smallest);
  std::fill(segments.reach[0], segments.reach[0] + 8, reach);
  ClippedSegments<8> clipped;
  const bool in_box = (segmentsInBox(segments, low, high, 0.0f, &clipped) >> kLane & 1) != 0;
  return {in_box, clipped.from[kLane], clipped.to[kLane]};
}

void toTriangleOnTarget(const FlatTriangle<float>& triangle, const float* x, const float* y, const float* z,
                        test::ToTriangle& out)
{
  squaredToTriangle(triangle, x, y, z, 8, out.squared);
}

test::PairVerdict comparePairOnTarget(const FlatTriangle<float>& triangle, const float* corners, float reach,
                                      float sure_square)
{
  LeafCorners leaf;
  for (std::size_t k = 0; k < 3; ++k) {
    std::fill(leaf.corners[k].x, leaf.corners[k].x + kLeafPoints, corners[3 * k]);
    std::fill(leaf.corners[k].y, leaf.corners[k].y + kLeafPoints, corners[3 * k + 1]);
    std::fill(leaf.corners[k].z, leaf.corners[k].z + kLeafPoints, corners[3 * k + 2]);
  }
  const LanesVerdict found = compareWithTriangle(triangle, leaf, firstBits(kLeafPoints), reach, sure_square);
  const LanesVerdict last = compareWithTriangle(triangle, leaf, 1u << (kLeafPoints - 1), reach, sure_square);
  const auto all = [](std::uint32_t bits) { return bits == firstBits(kLeafPoints); };
  if (all(found.apart) == (last.apart != 0) && all(found.within) == (last.within != 0))
    return {all(found.apart), all(found.within)};
  return {true, true}; // not alike in all lanes
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {
HWY_EXPORT(carryOnTarget);
HWY_EXPORT(squaredOnTarget);
HWY_EXPORT(testOnTarget);
HWY_EXPORT(slabsApartOnTarget);
HWY_EXPORT(gapsOnTarget);
HWY_EXPORT(segmentInBoxOnTarget);
HWY_EXPORT(toTriangleOnTarget);
HWY_EXPORT(comparePairOnTarget);
} // namespace

namespace test {

Carried carryEight(const float (&m)[9], const float (&g)[3], const float (&x)[8], const float (&y)[8],
                   const float (&z)[8])
{
  Carried carried;
  HWY_DYNAMIC_DISPATCH(carryOnTarget)(m, g, x, y, z, carried);
  return carried;
}

Squared squaredEight(const float (&x)[8], const float (&y)[8], const float (&z)[8], const float (&to)[3])
{
  Squared squared;
  HWY_DYNAMIC_DISPATCH(squaredOnTarget)(x, y, z, to, squared.of);
  return squared;
}

Near testSphere(const float (&center)[3], float radius, float stretch, const float (&ball)[3], float ball_radius,
                float prune_reach, float accept_reach)
{
  const float radius_stretch[2] = {radius, stretch}, reaches[2] = {prune_reach, accept_reach};
  return HWY_DYNAMIC_DISPATCH(testOnTarget)(center, radius_stretch, ball, ball_radius, reaches);
}

bool slabsApart(const TestSlab& slab, float stretch, const TestSlab& other, float reach)
{
  return HWY_DYNAMIC_DISPATCH(slabsApartOnTarget)(slab, stretch, other, reach);
}

Gaps gapsOf(const TestSlab& slab, const TestSlab& cross, float stretch, const TestSlab& other,
            const TestSlab& other_cross)
{
  return HWY_DYNAMIC_DISPATCH(gapsOnTarget)(slab, cross, stretch, other, other_cross);
}

Stay segmentInBox(const float (&start)[3], const float (&end)[3], const float (&bow)[3], float smallest, float reach,
                  const float (&low)[3], const float (&high)[3])
{
  return HWY_DYNAMIC_DISPATCH(segmentInBoxOnTarget)(start, end, bow, smallest, reach, low, high);
}

ToTriangle squaredToTriangleEight(const FlatTriangle<float>& triangle, const float (&x)[8], const float (&y)[8],
                                  const float (&z)[8])
{
  ToTriangle found;
  HWY_DYNAMIC_DISPATCH(toTriangleOnTarget)(triangle, x, y, z, found);
  return found;
}

PairVerdict comparePair(const FlatTriangle<float>& triangle, const float (&corners)[9], float reach, float sure_square)
{
  return HWY_DYNAMIC_DISPATCH(comparePairOnTarget)(triangle, corners, reach, sure_square);
}

} // namespace test
} // namespace pcl_bsh
#endif
