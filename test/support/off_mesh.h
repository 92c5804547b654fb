// SPDX-License-Identifier: BSD-3-Clause
// Meshes of OFF files in text, for tests of what knows no files.
#pragma once

#include <pcl_bsh/hierarchy/triangles_view.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh::test {

/// Float64 vertices; a face of more corners is a fan from the first.
struct OffMesh {
  std::vector<Point3> vertices;
  std::vector<Triangle> triangles;

  TrianglesView view() const
  {
    return {viewOf(vertices.front().data(), vertices.size()), triangles.front().data(), triangles.size()};
  }
};

/// @throws std::runtime_error naming the file when it is not there, or ends early
inline OffMesh readOffMesh(const std::string& path)
{
  std::ifstream file(path);
  std::string word;
  std::size_t vertices = 0, faces = 0, edges = 0;
  file >> word >> vertices >> faces >> edges;
  OffMesh mesh;
  mesh.vertices.resize(vertices);
  for (Point3& p : mesh.vertices)
    for (double& x : p) {
      file >> word; // not as a number: streams refuse what underflows
      x = std::strtod(word.c_str(), nullptr);
    }
  for (std::size_t i = 0; i < faces; ++i) {
    std::size_t count = 0;
    file >> count;
    std::vector<std::uint32_t> corners(count);
    for (std::uint32_t& corner : corners) file >> corner;
    for (std::size_t k = 1; k + 1 < count; ++k) mesh.triangles.push_back({corners[0], corners[k], corners[k + 1]});
  }
  if (!file || mesh.triangles.empty()) throw std::runtime_error(path + ": is no OFF file in text");
  return mesh;
}

} // namespace pcl_bsh::test
