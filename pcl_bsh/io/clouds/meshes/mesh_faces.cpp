// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>
#include <pcl_bsh/io/clouds/meshes/off_header.h>
#include <pcl_bsh/io/text/header_count.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <algorithm>
#include <array>
#include <string>

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

/// Whether a line `l` has two different vertices; one of the same is a point.
bool joinsVertices(TextCursor line)
{
  const auto next = [&] {
    const std::string_view corner = line.word();
    return corner.substr(0, corner.find('/'));
  };
  for (const std::string_view first = next(); !line.line().empty();)
    if (next() != first) return true;
  return false;
}

/// Lines of an .obj, by their keyword, that say something of a shape beside vertices and faces.
struct ObjKind {
  std::string_view keyword, one, many;
};

constexpr std::array<ObjKind, 8> obj_kinds = {{
    {"l", "line (l)", "lines (l)"},
    {"curv", "free-form curve (curv)", "free-form curves (curv)"},
    {"surf", "free-form surface (surf)", "free-form surfaces (surf)"},
    {"bsp", "B-spline patch (bsp)", "B-spline patches (bsp)"},
    {"bzp", "Bezier patch (bzp)", "Bezier patches (bzp)"},
    {"cdc", "Cardinal curve (cdc)", "Cardinal curves (cdc)"},
    {"cdp", "Cardinal patch (cdp)", "Cardinal patches (cdp)"},
    {"call", "file that it calls (call)", "files that it calls (call)"},
}};

} // namespace

std::optional<std::uint64_t> objPromise(std::string_view file, std::string_view one, std::string_view many)
{
  std::optional<std::uint64_t> promise;
  for (TextCursor comments(file); comments.nextLine() && comments.line().starts_with('#');) {
    std::string line = inSmallLetters(std::string(comments.line().substr(1, 80)));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ':' || c == '='; }, ' ');
    std::optional<std::uint64_t> count;
    bool named = false, other = false;
    for (TextCursor words(line); words.nextLine();) {
      while (!words.line().empty()) {
        const std::string_view word = words.word();
        const auto number = numberOf<std::uint64_t>(word);
        named = named || word == one || word == many;
        other = other || (number ? count.has_value()
                                 : word != one && word != many && word != "number" && word != "of" && word != "count");
        if (number) count = number;
      }
    }
    if (count && named && !other) promise = count;
  }
  return promise;
}

Polygons parseObjFaces(std::string_view file, std::vector<std::string>* remarks)
{
  Polygons polygons;
  std::uint64_t vertices = 0, fan = 0;
  for (TextCursor text = objText(file); text.nextLine();) {
    const std::string_view kind = text.word();
    if (kind == "v") ++vertices;
    if (kind == "f" || kind == "fo") { // "fo": what old programs write
      while (!text.line().empty()) {
        if (text.line() == "\\") throw FormatError("is truncated: it ends in a face");
        polygons.addCorner(text.parseWord([&](std::string_view corner) { return vertexOf(corner, vertices); }));
      }
      polygons.end();
      fan += std::max<std::size_t>(polygons[polygons.size() - 1].size(), 2) - 2;
      continue;
    }
    const auto left_out =
        std::find_if(obj_kinds.begin(), obj_kinds.end(), [&](const ObjKind& known) { return known.keyword == kind; });
    if (left_out != obj_kinds.end() && (kind != "l" || joinsVertices(text)))
      polygons.leftOut().add(left_out->one, left_out->many, true);
  }
  const std::optional<std::uint64_t> promised = objPromise(file, "face", "faces");
  if (remarks != nullptr && promised && *promised != fan)
    if (const auto other = remarkOnCount({*promised, "face", "faces"}, polygons.size())) remarks->push_back(*other);
  return polygons;
}

Polygons parseOffFaces(std::string_view file)
{
  TextCursor text(file, '#');
  const OffHeader header(text);
  for (std::uint64_t i = 0; i < header.vertices; ++i)
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its vertices");
  Polygons polygons;
  for (std::uint64_t i = 0; i < header.faces; ++i) {
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its faces");
    const auto corners = text.number<std::uint64_t>();
    for (std::uint64_t k = 0; k < corners; ++k) polygons.addCorner(text.number<std::uint64_t>());
    polygons.end(); // what is left of the line is a colour
  }
  return polygons;
}

} // namespace pcl_bsh::io
