// SPDX-License-Identifier: BSD-3-Clause
// Whether a mesh closes: by the numbers of its vertices, and by their places where numbers do not tell.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/triangle/open_edges.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <vector>

namespace pcl_bsh {

/// As findOpenEdges(). Quick where vertices are shared by number and the mesh closes; memory is then about 12 bytes for
/// a triangle, and 4 for a vertex. @pre as checkTriangles() asks
PCL_BSH_EXPORT_INTERNAL OpenEdges openEdgesOf(const TrianglesView& triangles, std::vector<OpenEdge>* all = nullptr);

} // namespace pcl_bsh
