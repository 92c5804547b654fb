// SPDX-License-Identifier: BSD-3-Clause
// H24: a caller compiled and linked with -ffast-math, which flushes denormals in all of the process and fuses what it
// likes. The library was not compiled so: its answers stay those of exact arithmetic.
#include <pcl_bsh/collide.h>

#include <cstdio>
#include <string>

#ifndef __FAST_MATH__
#error "compile this with -ffast-math"
#endif

namespace {

int failures = 0;

void expect(const char* name, const float (&p)[3], const float (&q)[3], double clearance, bool hit, double distance)
{
  const pcl_bsh::SphereHierarchy a(pcl_bsh::viewOf(p, 1)), b(pcl_bsh::viewOf(q, 1));
  pcl_bsh::FlagsRequest request;
  request.clearance = clearance;
  const bool any = pcl_bsh::anyCollision({a}, {b}, {clearance, {}}).verdict == pcl_bsh::Verdict::colliding;
  const bool flag = pcl_bsh::collisionFlags({a}, {b}, request).a[0] == pcl_bsh::Verdict::colliding;
  const double closest = pcl_bsh::closestPair({a}, {b}).distance;
  // As text: under -ffast-math a denormal compares equal to zero.
  char got[40], wanted[40];
  std::snprintf(got, sizeof got, "%a", closest);
  std::snprintf(wanted, sizeof wanted, "%a", distance);
  if (any == hit && flag == hit && std::string(got) == wanted) return;
  std::printf("%s: any %d, flag %d, distance %s; right are %d and %s\n", name, any, flag, got, hit, wanted);
  ++failures;
}

} // namespace

int main()
{
  expect("H1", {0, 0, 0}, {3, 4, 0}, 5, true, 5);
  expect("H2", {1, 2, 3}, {1, 2, 3}, 0, true, 0);
  expect("H3", {0, 0, 0}, {.1f, 0, 0}, .1, false, 0x1.99999ap-4);
  expect("H8", {0, 0, 0}, {0x1p-140f, 0, 0}, 0x1p-140, true, 0x1p-140);
  expect("H8 miss", {0, 0, 0}, {0x1p-140f, 0, 0}, 0x1p-141, false, 0x1p-140);
  expect("H9", {0, 0, 0}, {1e30f, 0, 0}, 2e30, true, static_cast<double>(1e30f));
  return failures == 0 ? 0 : 1;
}
