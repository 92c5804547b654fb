// SPDX-License-Identifier: BSD-3-Clause
// The named parts of a mesh file: the objects of an .obj, or its groups, and the solids of an .stl that is text.
//
//   const io::MeshParts parts = io::readMeshParts("plant.obj");
//   const io::Mesh whole = io::readMesh("plant.obj");
//   const std::vector<io::Mesh> meshes = io::meshesOf(parts, whole.vertices, whole.triangles); // as parts.names
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Parts that have faces, in the order of the file.
struct MeshParts {
  std::filesystem::path file;
  std::vector<std::string> names;
  std::vector<std::uint32_t> part_of; ///< of each triangle of the file
  std::vector<std::string> remarks;   ///< what is left out, a line each for users

  /// The name of a part as an obstacle: PART, or WHOLE/PART where the file's obstacle has a name.
  std::string nameOf(std::size_t part, const std::string& whole) const;
};

/// An .obj with lines `o` has objects as parts, and one without has groups: all that follows the letter is the name. A
/// group may go on later in the file; one without a name is `default`. Faces without a name and names without faces are
/// left out, with a remark.
/// @throws files::FileError for a file without named faces, and for two objects or solids of one name
MeshParts readMeshParts(const std::filesystem::path& file);

/// Each part with the vertices that it uses.
/// @param vertices, @param triangles those of the file, as readMesh() reads it
/// @throws files::FileError where the file has changed since its parts were read
std::vector<Mesh> meshesOf(const MeshParts& parts, const pcl::PCLPointCloud2& vertices,
                           const std::vector<Triangle>& triangles);

} // namespace pcl_bsh::io
