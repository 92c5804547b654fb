// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/ply/camera.h>
#include <pcl_bsh/io/clouds/ply/header.h>
#include <pcl_bsh/io/clouds/ply/ply.h>
#include <pcl_bsh/io/clouds/ply/types.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <initializer_list>

namespace pcl_bsh::io {

namespace {

std::uint8_t readType(TextCursor& text)
{
  const std::string_view word = text.word();
  for (const PlyType& type : ply_types) {
    if (word == type.name || word == type.sized_name) return type.datatype;
  }
  text.fail("has the type '" + std::string(word.substr(0, 40)) + "', which PLY does not know");
}

PlyProperty readProperty(TextCursor& text)
{
  PlyProperty property;
  if (TextCursor(text).word() == "list") {
    text.word();
    property.length_type = readType(text);
  }
  property.datatype = readType(text);
  property.name = text.word();
  if (property.name.empty()) text.fail("names no property");
  return property;
}

/// The viewpoint in a comment, if it is of cameraComment()'s form.
std::optional<Viewpoint> readViewpoint(TextCursor comment)
{
  if (comment.word() != ply_viewpoint_comment) return std::nullopt;
  Viewpoint viewpoint;
  for (double& value : viewpoint) {
    const std::optional<double> number = numberOf<double>(comment.word());
    if (!number) return std::nullopt;
    value = *number;
  }
  return viewpoint;
}

/// A grid of a scan says which of its places have a vertex.
bool saysNothingOfShape(std::string_view element)
{
  return element == "camera" || element == "material" || element == "range_grid";
}

} // namespace

PlyHeader readPlyHeader(TextCursor& text)
{
  PlyHeader header;
  if (!text.nextLine() || text.word() != "ply") throw FormatError("is not a PLY file: it does not start with 'ply'");
  while (text.nextLine()) {
    const std::string_view key = text.word();
    if (key == "comment") {
      if (const auto viewpoint = readViewpoint(text)) header.viewpoint = viewpoint;
      continue;
    }
    if (key == "end_header") return header;
    if (key == "format") {
      header.format = text.word();
    }
    else if (key == "obj_info") {
      const std::string_view what = text.word();
      if (what == "num_cols") header.columns = text.number<std::uint32_t>();
      if (what == "num_rows") header.rows = text.number<std::uint32_t>();
    }
    else if (key == "element") {
      const std::string name(text.word());
      header.elements.push_back({name, text.number<std::uint64_t>(), {}});
    }
    else if (key == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(readProperty(text));
    }
    else {
      text.fail("starts with '" + std::string(key.substr(0, 40)) + "', which no PLY header has there");
    }
  }
  throw FormatError("is truncated: its header does not end");
}

void leaveOut(const PlyElement& element, LeftOuts& left_out)
{
  if (saysNothingOfShape(element.name)) return;
  const auto tells = [](const std::string& name, std::initializer_list<const char*> parts) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const char* part) { return inSmallLetters(name).find(part) != std::string::npos; });
  };
  const bool joins = tells(element.name, {"edge", "line", "curve", "surf", "patch", "strip", "fan", "tet", "hex",
                                          "cell", "tri", "quad"}) ||
                     std::any_of(element.properties.begin(), element.properties.end(),
                                 [&](const PlyProperty& property) { return tells(property.name, {"vert"}); });
  const std::string name = " '" + element.name.substr(0, 40) + "'";
  left_out.add("element" + name, "elements" + name, joins, element.count);
}

bool isPlyOfPoints(std::string_view beginning)
{
  try {
    TextCursor text(beginning);
    const PlyHeader header = readPlyHeader(text);
    return std::all_of(header.elements.begin(), header.elements.end(), [](const PlyElement& element) {
      return element.name == "vertex" || saysNothingOfShape(element.name);
    });
  }
  catch (const FormatError&) { // a longer header, or a defect that reading it tells
    return false;
  }
}

} // namespace pcl_bsh::io
