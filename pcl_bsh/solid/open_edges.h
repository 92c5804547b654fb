// SPDX-License-Identifier: BSD-3-Clause
// Whether a mesh closes: its directed edges cancel along their lines.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// Edges, or parts of them, that nothing cancels. Several triangles may share an edge: what is left over of them
/// counts.
struct OpenEdges {
  std::uint64_t count = 0;   ///< open parts: parts of an edge that do not touch count each
  std::size_t triangle = 0;  ///< the first that has an open edge, if there is one
  Point3 from = {}, to = {}; ///< the first open part of that edge, in the triangle's direction

  bool closed() const noexcept { return count == 0; }
};

/// An open part of an edge. Its ends are corners, of its triangle or of others on the same line.
struct OpenEdge {
  std::size_t triangle;
  Point3 from, to;
};

/// Whether edges cancel along their lines, in exact arithmetic: of the edges on a line, as many pass a place one way as
/// the other way, for all places but corners. So an edge may be met by one edge between the same places, or by several
/// end to end (T-junctions). Corners are one where their coordinates are equal (0 equals -0). Triangles that are not
/// finite count for nothing, and corners on one line make edges that cancel themselves.
///
/// An edge between the same places is looked for first, so that meshes without T-junctions cost no arithmetic. The
/// others cost n log n exact comparisons for n edges, however they lie. Memory: about 12 bytes for a triangle and 4 for
/// a vertex where vertices are shared by number and each edge meets one between the same vertices. Otherwise about 40
/// bytes for a triangle, and 60 for an edge that is left.
/// @pre as checkTriangles() asks
/// @throws std::invalid_argument for 2^32 edges or 2^31 places
PCL_BSH_EXPORT_INTERNAL bool closes(const TrianglesView& triangles);

/// Finds the open edges. Where several edges pass a place in one direction and some of them cancel, those of the first
/// triangles are open.
/// @param all gets each open part, in the order of triangles, where it is not null
/// @pre, @throws as closes()
PCL_BSH_EXPORT_INTERNAL OpenEdges openEdgesOf(const TrianglesView& triangles, std::vector<OpenEdge>* all = nullptr);

} // namespace pcl_bsh
