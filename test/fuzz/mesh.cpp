// SPDX-License-Identifier: BSD-3-Clause
// Files of meshes: the first byte says which format, the rest is the file.
#include "read.h"

#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>
#include <pcl_bsh/io/clouds/meshes/stl.h>
#include <pcl_bsh/io/clouds/ply/ply.h>
#include <pcl_bsh/search/cloud_view.h>

namespace pcl_bsh::fuzz {

namespace {

pcl::PCLPointCloud2 parse(char format, std::string_view file, io::Polygons& faces, std::vector<Triangle>& triangles)
{
  io::Viewpoint ignored;
  switch (format) {
  case 's':
    return io::parseStl(file, &triangles);
  case 'p':
    return io::parsePly(file, ignored, &faces);
  case 'f':
    faces = io::parseOffFaces(file);
    return io::parseOff(file);
  default:
    faces = io::parseObjFaces(file);
    return io::parseObj(file);
  }
}

} // namespace

} // namespace pcl_bsh::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  if (size == 0) return 0;
  const std::string_view file(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    io::Polygons faces;
    std::vector<Triangle> triangles;
    pcl::PCLPointCloud2 vertices = fuzz::parse(static_cast<char>(data[0]), file, faces, triangles);
    fuzz::requireSound(vertices, file.size());
    if (vertices.width == 0) return 0;
    const PointsView view = viewOf(vertices);
    const io::LeftOuts left_out = io::leftOutOf(faces);
    fuzz::require(left_out.empty() || left_out.text().size() < 2000,
                  "more kinds of what is left out than a sentence has");
    std::vector<io::FaceValues> values;
    for (const Triangle& triangle : io::trianglesOf(faces, view, values)) triangles.push_back(triangle);
    fuzz::require(triangles.size() <= file.size(), "more triangles than the file has bytes");
    for (const Triangle& triangle : triangles)
      for (const std::uint32_t corner : triangle) fuzz::require(corner < view.count, "a corner that is not there");
  }
  catch (const io::FormatError& error) {
    fuzz::require(*error.what() != '\0' && !error.remedy().empty(), "a refusal without a reason");
  }
  catch (const std::invalid_argument&) { // x y z in types that are no coordinates
  }
  return 0;
}
