// SPDX-License-Identifier: BSD-3-Clause
// Whether a mesh closes: each directed edge is met by as many in the opposite direction.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <cstddef>
#include <cstdint>
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

/// Corners are one where their coordinates are equal (0 equals -0). Triangles that are not finite count for nothing,
/// and edges of no length cancel themselves. Memory: about 12 bytes for a triangle and 4 for a vertex where vertices
/// are shared by number and the mesh closes, otherwise about 40 for a triangle.
/// @param all gets each open edge, by their triangles, where it is not null
/// @pre as checkTriangles() asks
/// @throws std::invalid_argument for 2^32 edges or 2^31 places
PCL_BSH_EXPORT_INTERNAL OpenEdges openEdgesOf(const TrianglesView& triangles, std::vector<OpenEdge>* all = nullptr);

} // namespace pcl_bsh
