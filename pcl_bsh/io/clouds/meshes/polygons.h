// SPDX-License-Identifier: BSD-3-Clause
// The faces of a mesh file: polygons by their vertices, and the triangles they are cut into.
#pragma once

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/left_out.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pcl_bsh::io {

/// Polygons as a file has them. Corners are checked when they are cut, for files may give faces before vertices.
class Polygons {
public:
  void addCorner(std::uint64_t vertex) { corners_.push_back(vertex); }
  void end() { ends_.push_back(corners_.size()); }

  /// Values of the first, second ... polygon, beside its corners.
  std::vector<FaceValues>& values() { return values_; }
  const std::vector<FaceValues>& values() const { return values_; }

  /// Elements of the file that are neither vertex nor face.
  LeftOuts& leftOut() { return left_out_; }
  const LeftOuts& leftOut() const { return left_out_; }

  std::size_t size() const { return ends_.size(); }
  std::span<const std::uint64_t> operator[](std::size_t i) const
  {
    const std::size_t first = i == 0 ? 0 : ends_[i - 1];
    return std::span(corners_).subspan(first, ends_[i] - first);
  }

private:
  std::vector<std::uint64_t> corners_;
  std::vector<std::size_t> ends_;
  std::vector<FaceValues> values_;
  LeftOuts left_out_;
};

/// The triangles that addTriangles() (hierarchy/polygon_triangles.h) makes of the polygons.
/// @param values gets the values of polygons, repeated for each of their triangles
/// @throws FormatError when a polygon names a vertex that is not there, or has more than 4096 corners and is not convex
std::vector<Triangle> trianglesOf(const Polygons& polygons, const PointsView& vertices,
                                  std::vector<FaceValues>& values);

/// Parts of a mesh that are not compared: elements beside faces, and faces of fewer than three corners. Vertices
/// that no face has are counted by looseVertices().
LeftOuts leftOutOf(const Polygons& polygons);

} // namespace pcl_bsh::io
