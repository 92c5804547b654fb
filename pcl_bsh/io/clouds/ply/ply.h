// SPDX-License-Identifier: BSD-3-Clause
// The Stanford polygon format; its vertices are the points.
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/polygons.h>

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The vertices, with PCL's names and packed colours (pcl_names.h).
/// @param viewpoint set to what an element `camera` says, as PCL's writer has it, or to no_viewpoint
/// @param faces if not null, gets the polygons of elements `face` and the numbers beside their corners, the triangles
///   of `tristrips`, and the other elements of the file
/// @param remarks if not null, gets what users should know of how it was read
/// @throws FormatError; for a camera that is no rigid motion, too
pcl::PCLPointCloud2 parsePly(std::string_view file, Viewpoint& viewpoint, Polygons* faces = nullptr,
                             std::vector<std::string>* remarks = nullptr);

/// The vertices' fields and the number of them that the header promises, without the points. @throws FormatError
pcl::PCLPointCloud2 parsePlyHeader(std::string_view file);

/// Whether the bytes have a whole header, with elements of points alone: vertices, and elements that say nothing of a
/// shape.
bool isPlyOfPoints(std::string_view beginning);

/// Writes binary in this machine's byte order, with PLY's names: nx ny nz, and uchar red green blue [alpha] for a
/// packed colour. A field with a count is a list property, as PCL's own writer has it; a viewpoint is an element
/// `camera`, and a comment that has it in full.
/// @throws FormatError when a field cannot be held
void writePly(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Viewpoint& viewpoint);

/// Writes an element `face` of triangles, too, whose fields are properties beside the list `vertex_indices`.
/// @pre one value per triangle
void writePlyMesh(std::ostream& out, const pcl::PCLPointCloud2& vertices, const std::vector<Triangle>& triangles,
                  const std::vector<FaceField>& fields, const Viewpoint& viewpoint);

} // namespace pcl_bsh::io
