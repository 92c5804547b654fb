// SPDX-License-Identifier: BSD-3-Clause
// Triangles laid flat for the kernels that measure from them, and what float distances from them tell.
//
//   FlatTriangle<float> flat = flatten(frame, corners);           // in the frame of the voxel it is near to
//   DistanceBand band = frame_change.band(clearance, flat.error, kFlatShare);
//   squaredToTriangle(flat, x, y, z, count, squared);             // of carried points; <= hit, > miss, or ask again
#pragma once

#include <pcl_bsh/geometry/distance_band.h>
#include <pcl_bsh/geometry/local_frame.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/simd/flattened_triangle.h>

namespace pcl_bsh {

template <class Number>
inline constexpr double kFlatUnit = kFloatUnit; ///< unit roundoff of the arithmetic
template <>
inline constexpr double kFlatUnit<double> = kDoubleUnit;

/// How far the rows of a flat triangle may change lengths, as a share. Rounding nine entries of rows of length 1
/// changes them by less than 1.74 u, and the double arithmetic that made them by less than 32 v.
template <class Number>
inline constexpr double kFlatSkew = 2 * kFlatUnit<Number>;
template <>
inline constexpr double kFlatSkew<double> = 32 * kDoubleUnit;

/// The error that kernels and rows together make in a distance, as a share of it.
template <class Number>
inline constexpr double kFlatRelative = (kFlatTriangleUnits * kFlatUnit<Number> + kFlatSkew<Number>)*(1.0 + 0x1p-16);
inline constexpr double kFlatShare = kFlatRelative<float>;

/// Relative margin of lengths that are compared with such distances in float, and of bounds made of these: their share,
/// the root or the square, and a few products and sums; proved in test/proof/flat_margin.g.
inline constexpr float kFlatMargin = 0x1p-19f;

/// Lays a triangle flat. Then |sqrt(s) - D| <= kFlatRelative D + error. D is the distance of a point of its frame from
/// the given triangle, and s what squaredToTriangle() says, within kSquaredDistanceError of s.
///
/// Error bound: double arithmetic measures how far the rows carry each corner from where it is stored. It errs by less
/// than 16 v of the longest side. No place of a triangle moves farther than its corners. The kernel adds
/// kFlatTriangleUnits of the longest side. Sides too short for the inverse of their square count as points.
/// @param corners finite. @param slack how far the corners may be off. The error is infinite where coordinates are out
/// of the kernel's range.
template <class Number>
FlatTriangle<Number> flatten(const Triangle3& corners, double slack = 0.0);

/// Lays a triangle flat in a local frame. Its corners lie within the frame's reach.
FlatTriangle<float> flatten(const LocalFrame& frame, const Triangle3& corners);

/// Bounds of the distance from the given triangle. They follow from a squared distance in float, and from the error and
/// skew of a frame (RelativeFrame, PointFrame). All in the frame's unit.
struct DistanceBounds {
  double low, high;
};
inline DistanceBounds boundsOf(float squared, double error, double skew, const FlatTriangle<float>& triangle) noexcept
{
  const double length = std::sqrt(static_cast<double>(squared));
  const double doubt =
      (length * (kLengthError + kFlatShare + skew) + (error + static_cast<double>(triangle.error)) + kSmallestLength) *
      (1.0 + 0x1p-16);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(length + doubt < infinity)) return {0.0, infinity};
  return {std::max(length - doubt, 0.0), length + doubt};
}

} // namespace pcl_bsh
