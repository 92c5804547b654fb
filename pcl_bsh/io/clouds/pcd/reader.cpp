// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/lines/field_text.h>
#include <pcl_bsh/io/clouds/pcd/lzf.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/header_count.h>

#include <pcl/common/io.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace pcl_bsh::io {

namespace {

/// The lines before the points, as written.
struct PcdHeader {
  std::vector<std::string> names;
  std::vector<std::uint32_t> sizes;
  std::vector<char> types;
  std::vector<std::uint32_t> counts;
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  std::optional<std::uint64_t> points;
  Viewpoint viewpoint = no_viewpoint;
  std::string storage; ///< ascii, binary or binary_compressed
};

char typeLetter(TextCursor& text)
{
  const std::string_view word = text.word();
  if (word.size() != 1) text.fail("has the type '" + std::string(word.substr(0, 40)) + "', which must be F, I or U");
  return word.front();
}

/// Reads up to and including the DATA line.
PcdHeader readPcdHeader(TextCursor& text)
{
  PcdHeader header;
  while (text.nextLine()) {
    const std::string_view key = text.word();
    const auto list = [&](auto& values, auto read) {
      while (!text.line().empty()) values.push_back(read());
    };
    const auto number = [&] { return text.number<std::uint32_t>(); };
    if (key == "VERSION") continue;
    if (key == "FIELDS" || key == "COLUMNS") {
      list(header.names, [&] { return std::string(text.word()); });
    }
    else if (key == "SIZE") {
      list(header.sizes, number);
    }
    else if (key == "TYPE") {
      list(header.types, [&] { return typeLetter(text); });
    }
    else if (key == "COUNT") {
      list(header.counts, number);
    }
    else if (key == "WIDTH") {
      header.width = number();
    }
    else if (key == "HEIGHT") {
      header.height = number();
    }
    else if (key == "POINTS") {
      header.points = text.number<std::uint64_t>();
    }
    else if (key == "VIEWPOINT") {
      for (double& value : header.viewpoint) value = text.number<double>();
      if (!std::all_of(header.viewpoint.begin(), header.viewpoint.end(), [](double v) { return std::isfinite(v); })) {
        throw FormatError("has a VIEWPOINT that is not finite",
                          "write VIEWPOINT 0 0 0 1 0 0 0 where the sensor's pose is not known");
      }
    }
    else if (key == "DATA") {
      header.storage = text.word();
      return header;
    }
    else {
      text.fail("starts with '" + std::string(key.substr(0, 40)) + "', which no PCD header has");
    }
  }
  throw FormatError("is not a PCD file: it has no DATA line");
}

/// Field by field, with its place in the record; X Y Z are x y z. Fields named "_" are padding, which only binary
/// records have to keep; PCL gives some a count of 0, which takes no room.
void layOut(const PcdHeader& header, pcl::PCLPointCloud2& cloud)
{
  const std::size_t fields = header.names.size();
  const bool counted = !header.counts.empty();
  if (header.sizes.size() != fields || header.types.size() != fields || (counted && header.counts.size() != fields)) {
    throw FormatError("its FIELDS, SIZE, TYPE and COUNT lines differ in length");
  }
  for (std::size_t i = 0; i < fields; ++i) {
    const std::uint32_t count = counted ? header.counts[i] : 1;
    const int datatype =
        header.sizes[i] <= 8 ? pcl::getFieldType(static_cast<int>(header.sizes[i]), header.types[i]) : -1;
    const bool padding = header.names[i] == "_";
    if (!padding && (datatype < 0 || count == 0)) {
      throw FormatError("field '" + header.names[i] + "' has type " + header.types[i] + ", size " +
                        std::to_string(header.sizes[i]) + " and count " + std::to_string(count) +
                        ", which is no PCD field");
    }
    if (padding) {
      if (header.storage == "binary") addPadding(cloud, std::uint64_t{count} * header.sizes[i]);
    }
    else {
      addField(cloud, header.names[i], static_cast<std::uint8_t>(datatype), count);
    }
  }
  if (cloud.fields.empty()) throw FormatError("its header names no fields");
  for (const auto& [given, axis] : {std::pair{"X", "x"}, {"Y", "y"}, {"Z", "z"}}) {
    const auto named = [&](const char* name) {
      return std::find_if(cloud.fields.begin(), cloud.fields.end(),
                          [&](const pcl::PCLPointField& field) { return field.name == name; });
    };
    if (const auto field = named(given); field != cloud.fields.end() && named(axis) == cloud.fields.end())
      field->name = axis;
  }
}

/// Width and height that agree with POINTS, where both are given.
std::pair<std::uint32_t, std::uint32_t> extent(const PcdHeader& header)
{
  const std::uint64_t rows = header.height.value_or(1);
  const std::uint64_t points = header.points.value_or(header.width.value_or(0) * rows);
  requirePoints(points);
  const std::uint64_t columns = header.width.value_or(static_cast<std::uint32_t>(points));
  if (!header.points && !header.width) throw FormatError("its header has no POINTS line");
  if (columns * rows != points) {
    throw FormatError("its header says " + std::to_string(columns) + " x " + std::to_string(rows) + " and " +
                      counted(points, "point") + ", which disagree");
  }
  return {static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows)};
}

void readAscii(TextCursor& text, pcl::PCLPointCloud2& cloud, const PcdHeader& header)
{
  for (std::uint8_t* record = cloud.data.data(); record != cloud.data.data() + cloud.data.size();
       record += cloud.point_step) {
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its points");
    auto field = cloud.fields.begin();
    for (std::size_t column = 0; column < header.names.size(); ++column) {
      const std::uint32_t count = header.counts.empty() ? 1 : header.counts[column];
      const bool padding = header.names[column] == "_";
      for (std::uint32_t i = 0; i < count; ++i) {
        if (padding) {
          text.number<double>();
        }
        else {
          readNumber(text, field->datatype, record + field->offset + i * sizeOf(field->datatype));
        }
      }
      if (!padding) ++field;
    }
    text.requireEndOfLine();
  }
  requireNoMoreLines({std::uint64_t{cloud.width} * cloud.height}, text);
}

std::uint32_t readSize(std::string_view bytes)
{
  std::uint32_t size;
  std::memcpy(&size, bytes.data(), sizeof size);
  return size;
}

/// A compressed body is two sizes and then, as one LZF stream, all values of the first field, of the second, ...
std::vector<std::uint8_t> decompress(std::string_view body, std::uint64_t wanted)
{
  constexpr std::size_t sizes = 2 * sizeof(std::uint32_t);
  constexpr std::uint64_t lzf_most = 88; // bytes that LZF makes of one, at best: 264 of 3
  if (body.size() < sizes) throw FormatError("is truncated: its compressed points are missing");
  const std::uint32_t compressed = readSize(body);
  const std::uint32_t raw = readSize(body.substr(sizeof compressed));
  if (compressed > body.size() - sizes) {
    throw FormatError("is truncated: " + std::to_string(body.size() - sizes) + " of " + std::to_string(compressed) +
                      " compressed bytes are there");
  }
  if (raw != wanted || raw > compressed * lzf_most) {
    throw FormatError("its compressed points are " + std::to_string(raw) + " bytes, its header promises " +
                      std::to_string(wanted));
  }
  std::vector<std::uint8_t> columns(raw);
  if (!readLzf(body.substr(sizes, compressed), columns)) throw FormatError("its compressed points are damaged");
  return columns;
}

void readCompressed(std::string_view body, pcl::PCLPointCloud2& cloud, std::size_t points)
{
  const std::vector<std::uint8_t> columns = decompress(body, std::uint64_t{points} * cloud.point_step);
  const std::uint8_t* value = columns.data();
  allocate(cloud, cloud.width, cloud.height);
  for (const pcl::PCLPointField& field : cloud.fields) {
    const std::size_t size = sizeOf(field);
    for (std::size_t i = 0; i < points; ++i, value += size) {
      std::memcpy(cloud.data.data() + i * cloud.point_step + field.offset, value, size);
    }
  }
}

/// The fields and the size of the cloud that the header promises.
pcl::PCLPointCloud2 promised(const PcdHeader& header)
{
  pcl::PCLPointCloud2 cloud;
  layOut(header, cloud);
  std::tie(cloud.width, cloud.height) = extent(header);
  return cloud;
}

} // namespace

PcdBody findPcdBody(std::string_view beginning)
{
  TextCursor text(beginning, '#');
  const PcdHeader header = readPcdHeader(text);
  return {promised(header), header.storage, beginning.size() - text.rest().size()};
}

pcl::PCLPointCloud2 parsePcdHeader(std::string_view file)
{
  return findPcdBody(file).header;
}

pcl::PCLPointCloud2 parsePcd(std::string_view file, Viewpoint& viewpoint, std::vector<std::string>* remarks)
{
  TextCursor text(file, '#');
  const PcdHeader header = readPcdHeader(text);
  viewpoint = header.viewpoint;

  pcl::PCLPointCloud2 cloud = promised(header);
  const std::size_t points = std::size_t{cloud.width} * cloud.height;
  const std::string_view body = text.rest();
  const auto remarkOn = [&](std::string_view left) {
    if (!remarks) return;
    const auto more = remarkOnMoreBytes({points}, left.size(), left.substr(0, most_padding), cloud.point_step);
    if (more) remarks->push_back(*more);
  };
  if (points == 0) {
    if (header.storage == "ascii")
      requireNoMoreLines({}, text);
    else
      remarkOn(body);
    return cloud;
  }
  if (header.storage == "ascii") {
    std::uint64_t values = 0;
    for (std::size_t i = 0; i < header.names.size(); ++i) values += header.counts.empty() ? 1 : header.counts[i];
    requireBytes(points, 2 * values, body.size() + 1); // a digit and a separator each; the last needs none
    allocate(cloud, cloud.width, cloud.height);
    readAscii(text, cloud, header);
  }
  else if (header.storage == "binary") {
    requireBytes(points, cloud.point_step, body.size());
    allocate(cloud, cloud.width, cloud.height);
    std::memcpy(cloud.data.data(), body.data(), cloud.data.size());
    remarkOn(body.substr(cloud.data.size()));
  }
  else if (header.storage == "binary_compressed") {
    readCompressed(body, cloud, points);
    remarkOn(body.substr(2 * sizeof(std::uint32_t) + readSize(body)));
  }
  else {
    throw FormatError("its points are stored as '" + header.storage + "'", "use ascii, binary or binary_compressed");
  }
  return cloud;
}

} // namespace pcl_bsh::io
