// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/ply/camera.h>
#include <pcl_bsh/io/clouds/ply/header.h>
#include <pcl_bsh/io/clouds/ply/ply.h>
#include <pcl_bsh/io/clouds/ply/rows.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <string>

namespace pcl_bsh::io {

namespace {

using Property = PlyProperty;
using Element = PlyElement;

/// How much of a file is read.
enum class Part : std::uint8_t { all, header };

/// A number of any type.
template <typename Rows>
double readValue(Rows& rows, std::uint8_t datatype)
{
  std::uint8_t bytes[sizeof(std::uint64_t)];
  rows.value(datatype, bytes);
  return withFieldType(datatype, [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  });
}

/// How many values of the property come next; 1 if it is no list.
template <typename Rows>
std::uint64_t readLength(Rows& rows, const Property& property)
{
  if (!property.length_type) return 1;
  const double length = readValue(rows, *property.length_type);
  if (!(length >= 0 && length <= 0xffffffff))
    throw FormatError("a list of '" + property.name + "' has an impossible length");
  return static_cast<std::uint64_t>(length);
}

/// Whether an element has faces. Lines of faces may have more values than the header says, as MeshLab writes them:
/// these are ignored.
bool isFaces(const Element& element)
{
  return element.name == "face" || element.name == "tristrips";
}

template <typename Rows>
void skipElement(Rows& rows, const Element& element)
{
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    rows.begin();
    for (const Property& property : element.properties) {
      const std::uint64_t length = readLength(rows, property);
      rows.skip(property.datatype, length);
    }
    if (!isFaces(element)) rows.end();
  }
}

/// Lists have no length but in the rows: that of the first row must hold for all. Takes a copy of `rows`.
template <typename Rows>
std::vector<std::uint64_t> firstLengths(Rows rows, const Element& vertices)
{
  std::vector<std::uint64_t> lengths(vertices.properties.size(), 1);
  if (vertices.count == 0) return lengths;
  rows.begin();
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lengths[i] = readLength(rows, vertices.properties[i]);
    rows.skip(vertices.properties[i].datatype, lengths[i]);
  }
  return lengths;
}

template <typename Rows>
pcl::PCLPointCloud2 readVertices(Rows& rows, const Element& vertices, Part part)
{
  if (vertices.properties.empty()) throw FormatError("its vertices have no properties");
  const std::vector<std::uint64_t> lengths = firstLengths(rows, vertices);
  Fields values(lengths.size());
  std::uint64_t least_bytes = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Property& property = vertices.properties[i];
    values[i].name = property.name;
    values[i].datatype = property.datatype;
    values[i].count = static_cast<std::uint32_t>(lengths[i]);
    if (property.length_type) least_bytes += Rows::leastBytes(*property.length_type);
    least_bytes += lengths[i] * Rows::leastBytes(property.datatype);
  }
  pcl::PCLPointCloud2 cloud;
  const std::vector<std::uint32_t> offsets = layOutForPcl(values, cloud);
  requireBytes(vertices.count, least_bytes, rows.bytesLeft());
  if (part == Part::header) {
    cloud.width = static_cast<std::uint32_t>(vertices.count);
    cloud.height = 1;
    return cloud;
  }
  allocate(cloud, static_cast<std::uint32_t>(vertices.count));

  for (std::size_t row = 0; row < cloud.width; ++row) {
    std::uint8_t* const record = cloud.data.data() + row * cloud.point_step;
    rows.begin();
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const Property& property = vertices.properties[i];
      std::uint8_t* out = record + offsets[i];
      if (readLength(rows, property) != lengths[i]) {
        throw FormatError("the lists of its vertex property '" + property.name + "' differ in length",
                          "remove that property");
      }
      for (std::uint64_t k = 0; k < lengths[i]; ++k, out += sizeOf(property.datatype)) {
        rows.value(property.datatype, out);
      }
    }
    rows.end();
  }
  return cloud;
}

/// Takes what an element `camera` says in its first row.
template <typename Rows>
void readCamera(Rows& rows, Element camera, const std::optional<Viewpoint>& in_full, Viewpoint& viewpoint,
                std::vector<std::string>& remarks)
{
  PlyCamera read;
  rows.begin();
  for (const Property& property : camera.properties) {
    std::uint64_t length = readLength(rows, property);
    if (!property.length_type) {
      std::uint8_t bytes[sizeof(std::uint64_t)];
      rows.value(property.datatype, bytes);
      read.take(property.name, property.datatype, bytes);
      length = 0;
    }
    rows.skip(property.datatype, length);
  }
  rows.end();
  viewpoint = read.viewpoint(in_full, remarks);
  --camera.count;
  skipElement(rows, camera);
}

/// The value of a list of whole numbers.
template <typename Rows>
std::int64_t readIndex(Rows& rows, const Property& property)
{
  const double index = readValue(rows, property.datatype);
  if (!(index >= -1 && index <= 0xffffffff))
    throw FormatError("its list '" + property.name + "' holds no index of a vertex");
  return static_cast<std::int64_t>(index);
}

/// Takes the corners of a row: of a face, or of a strip of triangles, in which -1 begins another. Each triangle of a
/// strip shares an edge with the one before it, which goes along it the other way: every second one is turned round.
template <typename Rows>
void readCorners(Rows& rows, const Property& property, bool strips, Polygons& faces)
{
  std::vector<std::uint64_t> strip;
  for (std::uint64_t i = 0, length = readLength(rows, property); i < length; ++i) {
    const std::int64_t index = readIndex(rows, property);
    if (index < 0 && !strips) throw FormatError("a face names the vertex -1");
    if (index < 0) {
      strip.clear();
      continue;
    }
    strip.push_back(static_cast<std::uint64_t>(index));
    if (!strips) {
      faces.addCorner(strip.back());
    }
    else if (strip.size() >= 3) {
      const std::size_t last = strip.size() - 1;
      const bool turned = last % 2 != 0;
      for (const std::size_t k : {turned ? last - 1 : last - 2, turned ? last - 2 : last - 1, last})
        faces.addCorner(strip[k]);
      faces.end();
    }
  }
  if (!strips) faces.end();
}

bool isCorners(const Property& property)
{
  return property.length_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Whether each row is one polygon, so that the other properties of the row are of this polygon.
bool tellsOfPolygons(const Element& element, const Polygons& before)
{
  return element.name == "face" && before.size() == 0 &&
         std::count_if(element.properties.begin(), element.properties.end(), isCorners) == 1;
}

/// Takes what an element `face` or `tristrips` lists as its vertices, and the numbers beside; skips all else.
template <typename Rows>
void readFaces(Rows& rows, const Element& element, Polygons& faces)
{
  if (std::none_of(element.properties.begin(), element.properties.end(), isCorners))
    faces.leftOut().add("'" + element.name + "' without a list vertex_indices",
                        "'" + element.name + "' without a list vertex_indices", true, element.count);
  std::vector<FaceValues>& values = faces.values();
  const bool tells = tellsOfPolygons(element, faces);
  for (const Property& property : element.properties)
    if (tells && !property.length_type) values.push_back({property.name, {}});
  for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
    rows.begin();
    std::size_t value = 0;
    for (const Property& property : element.properties) {
      if (isCorners(property)) {
        readCorners(rows, property, element.name == "tristrips", faces);
      }
      else if (tells && !property.length_type) {
        values[value++].values.push_back(readValue(rows, property.datatype));
      }
      else {
        const std::uint64_t length = readLength(rows, property);
        rows.skip(property.datatype, length);
      }
    }
  }
}

/// Refuses rows behind the last that the header counts.
template <typename Rows>
void requireEnd(Rows& rows, const PlyHeader& header)
{
  const auto last = std::find_if(header.elements.rbegin(), header.elements.rend(),
                                 [](const Element& element) { return !element.properties.empty(); });
  if (last == header.elements.rend()) return rows.requireNoMore({0, "row", "rows"}, 1, true);
  std::uint64_t record = 0;
  bool exact = true;
  for (const Property& property : last->properties) {
    const std::uint64_t values = !property.length_type ? 1 : isCorners(property) ? 3 : 0;
    record += values * sizeOf(property.datatype) + (property.length_type ? sizeOf(*property.length_type) : 0);
    if (property.length_type) exact = false;
  }
  const std::string name = " '" + last->name.substr(0, 40) + "'";
  rows.requireNoMore({last->count, "row" + name, "rows" + name}, record, exact);
}

/// Reads all elements, also those that are not wanted: a file cut off behind its vertices is damaged, too.
template <typename Rows>
pcl::PCLPointCloud2 readElements(Rows rows, const PlyHeader& header, Part part, Viewpoint& viewpoint, Polygons* faces,
                                 std::vector<std::string>& remarks)
{
  std::optional<pcl::PCLPointCloud2> cloud;
  for (const Element& element : header.elements) {
    if (element.name == "camera" && element.count > 0 && !element.properties.empty()) {
      readCamera(rows, element, header.viewpoint, viewpoint, remarks);
    }
    else if (faces != nullptr && isFaces(element)) {
      readFaces(rows, element, *faces);
    }
    else if (element.name != "vertex") {
      if (faces != nullptr) leaveOut(element, faces->leftOut());
      skipElement(rows, element);
    }
    else if (!cloud) {
      cloud = readVertices(rows, element, part);
      if (part == Part::header) break;
    }
    else {
      throw FormatError("its header has two 'vertex' elements");
    }
  }
  if (!cloud) throw FormatError("has no 'vertex' element", "export it with vertices");
  if (part == Part::all) requireEnd(rows, header);
  return std::move(*cloud);
}

pcl::PCLPointCloud2 parse(std::string_view file, Part part, Viewpoint& viewpoint, Polygons* faces,
                          std::vector<std::string>& remarks)
{
  viewpoint = no_viewpoint;
  TextCursor text(file);
  const PlyHeader header = readPlyHeader(text);
  pcl::PCLPointCloud2 cloud;
  if (header.format == "ascii") {
    cloud = readElements(AsciiRows(text), header, part, viewpoint, faces, remarks);
  }
  else if (header.format == "binary_little_endian") {
    cloud = readElements(BinaryRows(text.rest(), std::endian::little), header, part, viewpoint, faces, remarks);
  }
  else if (header.format == "binary_big_endian") {
    cloud = readElements(BinaryRows(text.rest(), std::endian::big), header, part, viewpoint, faces, remarks);
  }
  else {
    throw FormatError("has the unknown format '" + header.format + "'",
                      "use ascii, binary_little_endian or binary_big_endian");
  }
  if (header.rows > 1 && header.columns * header.rows == cloud.width) {
    cloud.width = static_cast<std::uint32_t>(header.columns);
    cloud.height = static_cast<std::uint32_t>(header.rows);
    cloud.row_step = cloud.width * cloud.point_step;
  }
  return cloud;
}

} // namespace

pcl::PCLPointCloud2 parsePly(std::string_view file, Viewpoint& viewpoint, Polygons* faces,
                             std::vector<std::string>* remarks)
{
  std::vector<std::string> untold;
  return parse(file, Part::all, viewpoint, faces, remarks ? *remarks : untold);
}

pcl::PCLPointCloud2 parsePlyHeader(std::string_view file)
{
  Viewpoint ignored;
  std::vector<std::string> untold;
  return parse(file, Part::header, ignored, nullptr, untold);
}

} // namespace pcl_bsh::io
