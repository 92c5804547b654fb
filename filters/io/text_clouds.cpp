// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/records.h>
#include <pcl_bsh/filters/io/text_clouds.h>
#include <pcl_bsh/filters/io/text_cursor.h>

namespace pcl_bsh::io {

namespace {

pcl::PCLPointCloud2 emptyCloud(const std::vector<std::string>& names)
{
  pcl::PCLPointCloud2 cloud;
  for (const std::string& name : names) addField(cloud, name, pcl::PCLPointField::FLOAT64);
  return cloud;
}

/// Takes a number for each field from the line and makes them one more record.
void appendRecord(TextCursor& text, pcl::PCLPointCloud2& cloud)
{
  const std::size_t begin = cloud.data.size();
  cloud.data.resize(begin + cloud.point_step);
  for (const pcl::PCLPointField& field : cloud.fields) {
    text.number(field.datatype, cloud.data.data() + begin + field.offset);
  }
}

/// Once all records are there.
pcl::PCLPointCloud2 finished(pcl::PCLPointCloud2 cloud)
{
  const std::size_t points = cloud.data.size() / cloud.point_step;
  requirePoints(points);
  cloud.width = static_cast<std::uint32_t>(points);
  cloud.height = 1;
  cloud.row_step = cloud.width * cloud.point_step;
  return cloud;
}

std::vector<std::string> wordsOf(TextCursor line)
{
  std::vector<std::string> words;
  while (!line.line().empty()) words.emplace_back(line.word());
  return words;
}

/// Goes to the next line that is no comment of the // kind.
bool nextRow(TextCursor& text)
{
  do {
    if (!text.nextLine()) return false;
  } while (text.line().starts_with("//"));
  return true;
}

/// x y z column_4 column_5 ...
std::vector<std::string> defaultNames(std::size_t columns)
{
  std::vector<std::string> names = {"x", "y", "z"};
  for (std::size_t i = 4; i <= columns; ++i) names.push_back("column_" + std::to_string(i));
  return names;
}

/// A line without any number is no point: it names the columns.
bool namesColumns(const std::vector<std::string>& words)
{
  return std::none_of(words.begin(), words.end(), [](const std::string& word) { return isNumber(word); });
}

struct Columns {
  std::vector<std::string> names;
  bool at_row = false; ///< the text is at the first point; false when there is none
};

Columns readNames(TextCursor& text)
{
  Columns columns;
  columns.at_row = nextRow(text);
  columns.names = wordsOf(text);
  if (columns.at_row && namesColumns(columns.names)) {
    columns.at_row = nextRow(text);
    return columns;
  }
  if (columns.at_row && columns.names.size() < 3) text.fail("is no point: it has fewer than three numbers");
  columns.names = defaultNames(columns.names.size());
  return columns;
}

} // namespace

pcl::PCLPointCloud2 parseColumnNames(std::string_view file)
{
  TextCursor text(file, '#', ",;");
  return emptyCloud(readNames(text).names);
}

pcl::PCLPointCloud2 parseColumns(std::string_view file)
{
  TextCursor text(file, '#', ",;");
  const Columns columns = readNames(text);
  pcl::PCLPointCloud2 cloud = emptyCloud(columns.names);
  for (bool at_row = columns.at_row; at_row; at_row = nextRow(text)) {
    appendRecord(text, cloud);
    text.requireEndOfLine();
  }
  if (cloud.data.empty()) throw FormatError("holds no points", "give it a line of x y z per point");
  return finished(std::move(cloud));
}

pcl::PCLPointCloud2 parseObj(std::string_view file)
{
  TextCursor text(file, '#');
  pcl::PCLPointCloud2 cloud = emptyCloud({"x", "y", "z"});
  while (text.nextLine()) {
    if (text.word() == "v") appendRecord(text, cloud);
  }
  if (cloud.data.empty()) throw FormatError("has no vertices", "give it lines 'v x y z'");
  return finished(std::move(cloud));
}

pcl::PCLPointCloud2 parseOff(std::string_view file)
{
  TextCursor text(file, '#');
  const std::string_view kind = text.nextLine() ? text.word() : std::string_view();
  const bool flat = kind == "OFF" || kind == "COFF" || kind == "NOFF" || kind == "CNOFF" || kind == "STOFF" ||
                    kind == "STCOFF" || kind == "STNOFF" || kind == "STCNOFF";
  if (!flat) throw FormatError("is not an OFF file: it does not start with 'OFF'", "save it as text OFF");
  if (text.line().starts_with("BINARY")) throw FormatError("is a binary OFF file", "save it as text OFF");

  if (text.line().empty() && !text.nextLine()) throw FormatError("is truncated: it has no counts");
  const auto vertices = text.number<std::uint64_t>();
  const auto faces = text.number<std::uint64_t>();
  constexpr std::uint64_t least_bytes = 6; // three digits and their separators
  requireBytes(vertices, least_bytes, text.rest().size() + 1);

  pcl::PCLPointCloud2 cloud = emptyCloud({"x", "y", "z"});
  cloud.data.reserve(vertices * cloud.point_step);
  for (std::uint64_t i = 0; i < vertices; ++i) {
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its vertices");
    appendRecord(text, cloud);
  }
  // Faces do not matter, but a file cut off among them is damaged.
  for (std::uint64_t i = 0; i < faces; ++i) {
    if (!text.nextLine()) throw FormatError("is truncated: it ends before the last of its faces");
  }
  return finished(std::move(cloud));
}

} // namespace pcl_bsh::io
