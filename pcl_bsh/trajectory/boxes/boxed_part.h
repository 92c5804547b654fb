// SPDX-License-Identifier: BSD-3-Clause
// A ball, or a part of a triangle, with a box of the model around it.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

struct BoxedPart {
  BoxedPart(const Triangle3& at, std::uint32_t of);

  Triangle3 corners; ///< for a ball: two opposite corners of its box, and its centre
  double thickness;  ///< about how far a place in its box may be from the triangle
  std::uint32_t record;

  Point3 low() const noexcept;
  Point3 high() const noexcept;
};

/// How far triangles are divided into parts.
struct Division {
  double thin = 0.0;           ///< parts that are no thicker are not divided
  std::size_t most = 1U << 10; ///< most parts in all, or four for each triangle where that is more
};

/// Returns the division that pays where parts are compared with so many records of at most this radius. Parts finer
/// than the records tell no more, and for few records many parts are not worth their cost.
Division divisionFor(std::size_t records, double largest_radius);

/// Divides triangles that fill little of their boxes, the thickest first: a box around a large slanting triangle, or
/// around a needle, holds much that is far from it.
void divideThick(std::vector<BoxedPart>& parts, const Division& division);

} // namespace pcl_bsh
