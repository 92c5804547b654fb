// SPDX-License-Identifier: BSD-3-Clause
// What a box of the model is put around where that is not of points: a ball, or a part of a triangle.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <cstddef>
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

/// How far triangles are divided into parts.
struct Division {
  double thin = 0.0;           ///< what is no thicker is left as it is
  std::size_t most = 1U << 10; ///< parts in all; but four of each triangle
};

/// What pays where they are compared with so many records, none of which is larger: parts finer than these say no more,
/// and what is asked little is not worth many.
Division divisionFor(std::size_t records, double largest_radius);

/// Divides triangles that fill little of their boxes, the thickest first: a box around a large slanting triangle, or
/// around a needle, holds much that is far from it.
void divideThick(std::vector<BoxedPart>& parts, const Division& division);

} // namespace pcl_bsh
