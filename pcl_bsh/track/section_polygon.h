// SPDX-License-Identifier: BSD-3-Clause
// A closed outline in a section across an axis, and how far a point is outside of it.
#pragma once

#include <pcl_bsh/export.h>

#include <cstddef>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A place in a section: offset to the right, height up.
struct SectionPoint {
  double offset = 0.0, height = 0.0;

  /// Whether both numbers are equal.
  bool operator==(const SectionPoint& other) const { return offset == other.offset && height == other.height; }
};

/// A place of an outline.
struct OutlinePlace {
  SectionPoint at;
  std::size_t edge = 0; ///< from the corner with this number to the next
  double share = 0.0;   ///< of the edge
};

/// Error bound of signedDistance(), as a factor of the polygon's extent plus the distance.
inline constexpr double section_distance_error = 64 * 0x1p-53;

/// How far the point is from the outline: positive outside, negative inside, 0 exactly where it lies on the outline.
/// The sign is that of exact arithmetic on the given numbers. @pre a simple polygon, all numbers finite
/// @param nearest if not null, gets the outline's nearest place
double signedDistance(const std::vector<SectionPoint>& outline, const SectionPoint& point,
                      OutlinePlace* nearest = nullptr);

/// @return the corners, without those that repeat the one before
/// @throws InvalidInput naming the corners: fewer than three, one not finite, an outline that crosses or touches itself
std::vector<SectionPoint> simplePolygon(std::vector<SectionPoint> corners);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
