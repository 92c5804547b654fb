// SPDX-License-Identifier: BSD-3-Clause
// The float kernels as they are compiled for the instruction set in use: for tests that judge their rounding.
#pragma once

#include <pcl_bsh/simd/flattened_triangle.h>

namespace pcl_bsh::test {

/// Eight points carried, by carry(); and the first of them by carryPoint().
struct Carried {
  float x[8], y[8], z[8];
  float point[3];
};
Carried carryEight(const float (&m)[9], const float (&g)[3], const float (&x)[8], const float (&y)[8],
                   const float (&z)[8]);

/// From each of eight points to another, by centersSquared().
struct Squared {
  alignas(32) float of[8];
};
Squared squaredEight(const float (&x)[8], const float (&y)[8], const float (&z)[8], const float (&to)[3]);

/// spheresNear() and spheresInside() of one sphere, for a ball that has the reaches as queries compose them.
struct Near {
  bool near, inside;
};
Near testSphere(const float (&center)[3], float radius, float stretch, const float (&ball)[3], float ball_radius,
                float prune_reach, float accept_reach);

/// slabsApart() of one slab in a sphere against another one.
struct TestSlab {
  float normal[3], h, center[3], radius;
};
bool slabsApart(const TestSlab& slab, float stretch, const TestSlab& other, float reach);

/// slabGaps() of the same; supportGaps(), where `cross` and `other_cross` are second slabs of the same spheres; and
/// pointsGap() from the other slab's centre to the slab, its radius stretched.
struct Gaps {
  float slabs, supports, point;
};
Gaps gapsOf(const TestSlab& slab, const TestSlab& cross, float stretch, const TestSlab& other,
            const TestSlab& other_cross);

/// segmentsInBox() of one segment, at all instants.
struct Stay {
  bool in_box;
  float from, to;
};
Stay segmentInBox(const float (&start)[3], const float (&end)[3], const float (&bow)[3], float smallest, float reach,
                  const float (&low)[3], const float (&high)[3]);

/// squaredToTriangle() of eight points.
struct ToTriangle {
  alignas(32) float squared[8];
};
ToTriangle squaredToTriangleEight(const FlatTriangle<float>& triangle, const float (&x)[8], const float (&y)[8],
                                  const float (&z)[8]);

/// compareWithTriangle() of one triangle, its corners x y z each.
struct PairVerdict {
  bool apart, within;
};
PairVerdict comparePair(const FlatTriangle<float>& triangle, const float (&corners)[9], float reach, float sure_square);

} // namespace pcl_bsh::test
