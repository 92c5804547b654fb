// SPDX-License-Identifier: BSD-3-Clause
// Directed edges on one line: what is left of them where opposite ones cancel.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace pcl_bsh {

/// An edge on a line. Places on it are ordered by the first coordinate that differs.
struct EdgeOnLine {
  Point3 low, high;    ///< low < high
  bool rises;          ///< it goes from low to high
  std::size_t ordinal; ///< where there is a choice, the edges with the least ordinals are left
};

/// Calls visit(i, low, high) for each part of edge i that is left, each as long as possible. Where n more edges go one
/// way than the other, n of them are left.
///
/// A sweep over the places where edges begin and end: n log n for n edges, however they lie.
void cancelAlongLine(const std::vector<EdgeOnLine>& edges,
                     const std::function<void(std::size_t, const Point3&, const Point3&)>& visit);

} // namespace pcl_bsh
