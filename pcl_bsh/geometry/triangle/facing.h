// SPDX-License-Identifier: BSD-3-Clause
// Two triangles whose planes face each other: their distance is known by the planes, though any number of their corners
// and edges may be the nearest.
#pragma once

#include <pcl_bsh/geometry/exact/long_number.h>
#include <pcl_bsh/geometry/triangle/vector3.h>

#include <array>
#include <optional>

namespace pcl_bsh {

using LongCorners = std::array<Vector3<LongNumber>, 3>;

/// The distance of two triangles that lie across one axis, where a place of one surely is above a place of the other;
/// exact. Nothing where numbers are not exact, or that is not sure.
std::optional<LongNumber> gapOfFacing(const LongCorners& a, const LongCorners& b);

/// Whether they are surely farther apart than a length, along the normal of one of both. @param length >= 0
bool areFacesBeyond(const LongCorners& a, const LongCorners& b, const LongNumber& length);

} // namespace pcl_bsh
