// SPDX-License-Identifier: BSD-3-Clause
#include "kernels.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "test/geometry/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/simd/sphere_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

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
  std::fill(x, x + 8, center[0]);
  std::fill(y, y + 8, center[1]);
  std::fill(z, z + 8, center[2]);
  std::fill(r, r + 8, radius_stretch[0]);
  const SphereLanes spheres{x, y, z, r, radius_stretch[1]};
  const Ball held{ball[0], ball[1], ball[2], ball_radius + reaches[0],
                  reaches[1] - ball_radius * (1.0f + kSphereMargin)};
  return {(spheresNear(spheres, held, nullptr) & 1) != 0, (spheresInside(spheres, held) & 1) != 0};
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

} // namespace test
} // namespace pcl_bsh
#endif
