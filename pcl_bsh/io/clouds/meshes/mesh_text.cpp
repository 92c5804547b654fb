// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/lines/text_rows.h>
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>
#include <pcl_bsh/io/clouds/meshes/off_header.h>
#include <pcl_bsh/io/text/header_count.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace pcl_bsh::io {

namespace {

/// The colours that the vertices have, seen over all of them before the first is stored.
/// Three or four numbers of a vertex line: whole ones from 0 to 255, or shares of 1.
class ColourScan {
public:
  /// How the numbers are stored: a byte each, given as such; a byte each, given as a share of 1; as they are.
  enum class Kind : std::uint8_t { bytes, shares, as_given };

  /// @param words of a vertex line, less its coordinates; no colour unless they are three or four
  void see(std::span<const std::string_view> words)
  {
    if (words.size() < 3 || words.size() > 4) return;
    channels_ = std::max(channels_, words.size());
    for (const std::string_view word : words) {
      const double value = numberOf<double>(word).value_or(-1); // no number: is refused when it is read
      if (!numberOf<std::uint8_t>(word)) bytes_ = false;
      constexpr double three_digits = 0.15; // how far a 255th written with three digits is from a whole one
      if (!(value >= 0 && value <= 1 && std::abs(value * 255 - std::round(value * 255)) <= three_digits))
        shares_ = false;
    }
  }

  std::size_t channels() const { return channels_; } ///< 0: no vertex has a colour

  Kind kind() const
  {
    if (shares_) return Kind::shares;
    return bytes_ ? Kind::bytes : Kind::as_given;
  }

private:
  std::size_t channels_ = 0;
  bool bytes_ = true;
  bool shares_ = true;
};

/// Vertices of a mesh file, with what the format has beside coordinates.
class Vertices {
public:
  /// @param colour_first whether colours stand before normals in a line that has both
  Vertices(bool normals, const ColourScan& colours, bool colour_first = false)
  : colours_(colours),
    rows_(valuesOf(normals, colours)),
    first_channel_(normals ? 6 : 3),
    colour_first_(colour_first)
  {
  }

  TextRows& rows() { return rows_; }

  /// Adds a vertex; white where others have a colour and it has none.
  /// @param with_normal whether the line has one
  /// @param given the number of its values from the coordinates to the colour
  void add(TextCursor& text, bool with_normal, std::size_t given)
  {
    const std::size_t record = rows_.size();
    rows_.add();
    const std::size_t before = with_normal ? first_channel_ : 3;
    rows_.take(text, record, 0, colour_first_ ? 3 : before);
    const std::size_t left = given > before ? given - before : 0;
    const std::size_t channels = left == 3 || left == 4 ? left : 0;
    for (std::size_t i = 0; i < colours_.channels(); ++i) addChannel(text, record, i, i < channels);
    if (colour_first_) rows_.take(text, record, 3, before);
    while (!text.line().empty()) text.number<double>(); // they mean nothing here, but two lines joined to one are found
  }

private:
  static Fields valuesOf(bool normals, const ColourScan& colours)
  {
    using Field = pcl::PCLPointField;
    Fields values = {textValue("x"), textValue("y"), textValue("z")};
    if (normals)
      for (const char* name : {"nx", "ny", "nz"}) values.push_back(textValue(name));
    const std::uint8_t type = colours.kind() == ColourScan::Kind::as_given ? Field::FLOAT64 : Field::UINT8;
    for (std::size_t i = 0; i < colours.channels(); ++i) values.push_back(textValue(ply_channels[i], type));
    return values;
  }

  void addChannel(TextCursor& text, std::size_t record, std::size_t channel, bool given)
  {
    const std::size_t i = first_channel_ + channel;
    if (given && colours_.kind() != ColourScan::Kind::shares) return rows_.take(text, record, i, i + 1);
    const double share = given ? text.number<double>() : 1.0;
    if (colours_.kind() == ColourScan::Kind::as_given) {
      std::memcpy(rows_.at(record, i), &share, sizeof share);
    }
    else {
      *rows_.at(record, i) = static_cast<std::uint8_t>(std::lround(share * 255));
    }
  }

  ColourScan colours_;
  TextRows rows_;
  std::size_t first_channel_;
  bool colour_first_;
};

std::size_t countWords(TextCursor line)
{
  std::size_t count = 0;
  for (; !line.line().empty(); ++count) line.word();
  return count;
}

/// Shows a vertex line to `colours`: what stands behind its first `before` words, less the last `behind`.
void seeColour(TextCursor line, std::size_t before, std::size_t behind, ColourScan& colours)
{
  std::array<std::string_view, 16> words;
  std::size_t count = 0;
  while (count < words.size() && !line.line().empty()) words[count++] = line.word();
  if (count < before + behind) return;
  colours.see(std::span(words).subspan(before, count - before - behind));
}

/// The counts of an .obj.
struct ObjScan {
  std::size_t vertices = 0;
  std::size_t normals = 0;
  std::optional<std::uint64_t> promised; ///< vertices, by a comment
  bool normals_follow_vertices = true;   ///< no face gives a vertex another one's normal
  ColourScan colours;

  bool hasNormals() const { return normals > 0 && normals == vertices && normals_follow_vertices; }
};

/// `v`, `v/t` or `v//n`, or `v/t/n` with n = v.
bool namesItsOwnNormal(std::string_view corner)
{
  const std::size_t last = corner.rfind('/');
  if (last == std::string_view::npos || corner.find('/') == last) return true;
  return corner.substr(last + 1) == corner.substr(0, corner.find('/'));
}

ObjScan scanObj(std::string_view file)
{
  ObjScan scan;
  scan.promised = objPromise(file, "vertex", "vertices");
  TextCursor text = objText(file);
  while (text.nextLine()) {
    const std::string_view kind = text.word();
    if (kind == "v") {
      ++scan.vertices;
      seeColour(text, 3, 0, scan.colours);
    }
    else if (kind == "vn") {
      ++scan.normals;
    }
    else if (kind == "f" || kind == "fo" || kind == "p" || kind == "l") {
      while (!text.line().empty()) {
        if (!namesItsOwnNormal(text.word())) scan.normals_follow_vertices = false;
      }
    }
  }
  return scan;
}

/// Whether three words of a vertex line from `at` on are a direction: of length 1 to a few digits, or 0.
bool isDirection(TextCursor line, std::size_t at)
{
  std::array<double, 3> n{};
  for (std::size_t i = 0; i < at; ++i) line.word();
  for (double& value : n) value = numberOf<double>(line.word()).value_or(9);
  const double length = std::hypot(n[0], n[1], n[2]);
  constexpr double few_digits = 1e-3;
  return length == 0 || std::abs(length - 1) <= few_digits;
}

/// Normals stand before colours; some programs that name them first in the keyword have them last in the lines.
Vertices verticesOf(const OffHeader& header, const TextCursor& text)
{
  const std::size_t texture = header.texture ? 2 : 0;
  bool colour_first = header.normals_named_first && header.colours;
  TextCursor lines = text;
  for (std::uint64_t i = 0; colour_first && i < header.vertices && lines.nextLine(); ++i) {
    const std::size_t words = countWords(lines);
    colour_first = words >= 9 + texture && !isDirection(lines, 3) && isDirection(lines, words - texture - 3);
  }
  lines = text;
  ColourScan colours;
  for (std::uint64_t i = 0; header.colours && i < header.vertices && lines.nextLine(); ++i) {
    const std::size_t normals = header.normals ? 3 : 0;
    seeColour(lines, colour_first ? 3 : 3 + normals, texture + (colour_first ? normals : 0), colours);
  }
  return {header.normals, colours, colour_first && header.vertices > 0};
}

} // namespace

pcl::PCLPointCloud2 parseObjHeader(std::string_view file)
{
  const ObjScan scan = scanObj(file);
  return std::move(Vertices(scan.hasNormals(), scan.colours).rows()).finished();
}

pcl::PCLPointCloud2 parseObj(std::string_view file, std::vector<std::string>* remarks)
{
  const ObjScan scan = scanObj(file);
  if (scan.vertices == 0 && scan.promised != 0) throw FormatError("has no vertices", "give it lines 'v x y z'");
  if (scan.vertices < scan.promised.value_or(0)) {
    throw FormatError("is truncated: it has " + std::to_string(scan.vertices) + " of the " +
                      counted(*scan.promised, "vertex", "vertices") + " that a comment promises");
  }
  const HeaderCount told{scan.promised.value_or(scan.vertices), "vertex", "vertices"};
  const auto more = remarkOnCount(told, scan.vertices);
  if (remarks && more) remarks->push_back(*more);
  Vertices vertices(scan.hasNormals(), scan.colours);
  TextRows& rows = vertices.rows();
  rows.reserve(scan.vertices);
  for (TextCursor text = objText(file); text.nextLine();) {
    if (text.word() == "v") vertices.add(text, false, countWords(text));
  }
  std::size_t next = 0;
  for (TextCursor text = objText(file); scan.hasNormals() && text.nextLine();) {
    if (text.word() == "vn") rows.take(text, next++, 3, 6);
  }
  return std::move(rows).finished();
}

pcl::PCLPointCloud2 parseOffHeader(std::string_view file)
{
  TextCursor text(file, '#');
  const OffHeader header(text);
  header.requireRoom(text);
  return std::move(verticesOf(header, text).rows()).finished();
}

pcl::PCLPointCloud2 parseOff(std::string_view file)
{
  TextCursor text(file, '#');
  const OffHeader header(text);
  header.requireRoom(text);
  Vertices vertices = verticesOf(header, text);
  vertices.rows().reserve(header.vertices);
  for (std::uint64_t i = 0; i < header.vertices; ++i) {
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its vertices");
    const std::size_t words = countWords(text), texture = header.texture ? 2 : 0;
    vertices.add(text, header.normals, words > texture ? words - texture : 0);
  }
  // Faces do not matter, but a file cut off among them is damaged.
  for (std::uint64_t i = 0; i < header.faces; ++i) {
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its faces");
  }
  requireNoMoreLines({header.faces, "face", "faces"}, text);
  return std::move(vertices.rows()).finished();
}

} // namespace pcl_bsh::io
