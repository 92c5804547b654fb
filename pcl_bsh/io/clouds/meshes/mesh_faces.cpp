// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <limits>

namespace pcl_bsh::io {

namespace {

/// The vertex that a corner `v`, `v/t`, `v//n` or `v/t/n` names, from 0.
std::uint64_t vertexOf(std::string_view corner, std::uint64_t vertices)
{
  const auto index = parseNumber<std::int64_t>(corner.substr(0, corner.find('/')));
  if (index > 0) return static_cast<std::uint64_t>(index) - 1;
  const std::uint64_t back = static_cast<std::uint64_t>(-(index + 1)) + 1;
  if (index == 0 || back > vertices) {
    throw FormatError("'" + std::string(corner.substr(0, 40)) + "' names no vertex: there are " +
                      std::to_string(vertices) + " before it");
  }
  return vertices - back;
}

} // namespace

Polygons parseObjFaces(std::string_view file)
{
  Polygons polygons;
  std::uint64_t vertices = 0;
  for (TextCursor text(file, '#'); text.nextLine();) {
    const std::string_view kind = text.word();
    if (kind == "v") ++vertices;
    if (kind != "f" && kind != "fo") continue; // "fo": what old programs write
    while (!text.line().empty()) {
      if (text.line() == "\\") { // the face goes on in the next line
        if (!text.nextLine()) throw FormatError("is truncated: it ends in a face");
        continue;
      }
      polygons.addCorner(text.parseWord([&](std::string_view corner) { return vertexOf(corner, vertices); }));
    }
    polygons.end();
  }
  return polygons;
}

Polygons parseOffFaces(std::string_view file)
{
  TextCursor text(file, '#');
  text.nextLine();
  text.word(); // OFF and its relatives; the counts stand here or in the next line
  if (text.line().empty()) text.nextLine();
  const auto vertices = text.number<std::uint64_t>(), faces = text.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < vertices; ++i)
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its vertices");
  Polygons polygons;
  for (std::uint64_t i = 0; i < faces; ++i) {
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its faces");
    const auto corners = text.number<std::uint64_t>();
    for (std::uint64_t k = 0; k < corners; ++k) polygons.addCorner(text.number<std::uint64_t>());
    polygons.end(); // what is left of the line is a colour
  }
  return polygons;
}

} // namespace pcl_bsh::io
