// SPDX-License-Identifier: BSD-3-Clause
// Whether triangles close: each directed edge is met by as many in the opposite direction.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace pcl_bsh {

/// Edges that nothing cancels. Several triangles may share an edge: what is left over of them counts.
struct OpenEdges {
  std::uint64_t count = 0;
  std::size_t triangle = 0;  ///< the first that has an open edge, if there is one
  Point3 from = {}, to = {}; ///< that edge, as the triangle has it

  bool closed() const noexcept { return count == 0; }
};

/// One of them, as its triangle has it.
struct OpenEdge {
  std::size_t triangle;
  Point3 from, to;
};

/// Of up to 2^31 - 1 triangles. Corners are one where their coordinates are equal (0 equals -0). Triangles that are not
/// finite count for nothing, and edges of no length cancel themselves. Memory: about 36 bytes for a triangle.
/// @param triangle called with 0 .. count - 1, twice for most
/// @param all gets each open edge, by their triangles, where it is not null
/// @throws std::invalid_argument for more triangles
PCL_BSH_EXPORT_INTERNAL OpenEdges findOpenEdges(std::size_t count,
                                                const std::function<Triangle3(std::size_t)>& triangle,
                                                std::vector<OpenEdge>* all = nullptr);

} // namespace pcl_bsh
