// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/polygon_triangles.h>
#include <pcl_bsh/io/clouds/meshes/polygons.h>
#include <pcl_bsh/io/text/format_error.h>

#include <limits>
#include <string>

namespace pcl_bsh::io {

std::vector<Triangle> trianglesOf(const Polygons& polygons, const PointsView& vertices, std::vector<FaceValues>& values)
{
  for (const FaceValues& known : polygons.values()) values.push_back({known.name, {}});
  std::vector<Triangle> triangles;
  triangles.reserve(polygons.size());
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    corners.clear();
    for (const std::uint64_t vertex : polygons[i]) {
      if (vertex >= vertices.count) {
        throw FormatError("face " + std::to_string(i) + " names vertex " + std::to_string(vertex) + " (from 0), of " +
                          std::to_string(vertices.count));
      }
      corners.push_back(static_cast<std::uint32_t>(vertex));
    }
    try {
      addTriangles(vertices, corners.data(), corners.size(), triangles);
    }
    catch (const InvalidInput& error) {
      throw FormatError(error.wrong(), error.remedy());
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::vector<double>& known = polygons.values()[k].values;
      values[k].values.resize(triangles.size(), i < known.size() ? known[i] : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return triangles;
}

LeftOuts leftOutOf(const Polygons& polygons)
{
  LeftOuts left_out = polygons.leftOut();
  std::uint64_t thin = 0;
  bool joins = false;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (!polygons[i].empty() && polygons[i].size() < 3) ++thin;
    if (polygons[i].size() == 2) joins = true;
  }
  left_out.add("face of fewer than three corners", "faces of fewer than three corners", joins, thin);
  return left_out;
}

} // namespace pcl_bsh::io
