// SPDX-License-Identifier: BSD-3-Clause
// Two triangles whose planes face each other: their distance is known by the planes, though any number of their corners
// and edges may be the nearest.
#pragma once

#include <pcl_bsh/geometry/triangle/nearest_features.h>
#include <pcl_bsh/geometry/triangle/vector3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace pcl_bsh {

using LongCorners = std::array<Vector3<LongNumber>, 3>;

/// The exact distance of two triangles that are both perpendicular to one axis, where a place of one surely is above a
/// place of the other. Nothing where numbers are not exact, or where that is not sure.
std::optional<LongNumber> gapOfFacing(const LongCorners& a, const LongCorners& b);

/// Whether two triangles are surely farther apart than sqrt(numerator / denominator), along the normal of one of them.
/// @param numerator >= 0 @param denominator > 0
bool areFacesBeyond(const LongCorners& a, const LongCorners& b, const LongNumber& numerator,
                    const LongNumber& denominator);

/// Whether all corners of b are at one height above the plane of a; nothing where that is not known.
template <class Number>
std::optional<bool> areParallel(const std::array<Vector3<Number>, 3>& a, const std::array<Vector3<Number>, 3>& b)
{
  const Vector3<Number> normal = cross(a[1] - a[0], a[2] - a[0]);
  bool sure = true;
  for (std::size_t j = 1; j < 3; ++j) {
    bool known = true;
    if (signOf(dot(normal, b[j] - b[0]), known) != 0) return false;
    sure = sure && known;
  }
  return sure ? std::optional(true) : std::nullopt;
}

/// How two triangles in parallel planes lie to each other.
enum class PlaneOverlap : std::uint8_t {
  unknown,
  over,  ///< a place of one is straight above a place of the other: they are as far apart as the planes
  beside ///< none is: they are farther apart than the planes
};

/// @pre areParallel()
PlaneOverlap overlapOf(const LongCorners& a, const LongCorners& b);

} // namespace pcl_bsh
