// SPDX-License-Identifier: BSD-3-Clause
// A triangle in a frame of its own, as the kernels of triangle_lanes-inl.h read it.
#pragma once

#include <pcl_bsh/simd/roundings.h>

namespace pcl_bsh {

/// The triangle (0, 0, 0), (length, 0, 0), (apex_x, apex_y, 0) in the frame y = rows (x - origin), with the numbers
/// that the kernels need. Its length is the longest side, 0 <= apex_x <= length and apex_y >= 0.
/// @tparam Number float or double
template <class Number>
struct FlatTriangle {
  Number origin[3] = {};
  Number rows[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}; ///< orthonormal within rounding
  Number length = 0, apex_x = 0, apex_y = 0;
  Number to_start = 0, to_end = 0; ///< one over the squares of the apex's two sides; 0 where that is too large
  Number rise = 0, fall = 0;       ///< slopes of these sides above the longest, not negative; large where upright
  Number error = 0;                ///< in the frame's unit: see flatten()
};

/// Roundings of the kernel squaredToTriangle(), of which each is u of a length; derived there.
inline constexpr int kFlatTurnRoundings = 4;  ///< of a point turned into the triangle's frame, in each coordinate
inline constexpr int kFlatAlongRoundings = 4; ///< of a parameter along a side, relative to the terms of its products
inline constexpr int kFlatUnderRoundings = 3; ///< of the height of a side above a place of the longest
/// The sum of these errors, in units of (distance + longest side): proved in test/proof/triangles.g.
inline constexpr int kFlatTriangleUnits = 15;

/// Error of a gap between a flat triangle and one in a lane, per unit of the direction's length. It has two parts:
/// kTrianglePairUnits in u of a length, and kTrianglePairMargin as a share of the compared value. The length is the
/// greatest distance of a corner from the flat one's origin, plus the flat one's longest side. Derived in
/// triangle_pair_lanes-inl.h, proved in test/proof/triangle_pairs.g.
inline constexpr int kTrianglePairUnits = 8;
inline constexpr float kTrianglePairMargin = 0x1p-18f;

} // namespace pcl_bsh
