// SPDX-License-Identifier: BSD-3-Clause
// What a box of the model is put around where that is not of points: a ball, or a part of a triangle.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

struct BoxedPart {
  BoxedPart(const Triangle3& at, std::uint32_t of);

  Triangle3 corners; ///< of a ball, two of its box
  double thickness;  ///< about how far a place in its box may be from the triangle
  std::uint32_t record;

  Point3 low() const noexcept;
  Point3 high() const noexcept;
};

/// Divides triangles that fill little of their boxes, the thickest first: a box around a large slanting triangle, or
/// around a needle, holds much that is far from it. No more than 2^10 parts come of it in all, or four of each
/// triangle.
/// @param thin what is no thicker is left as it is
void divideThick(std::vector<BoxedPart>& parts, double thin);

} // namespace pcl_bsh
