// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/records.h>
#include <pcl_bsh/filters/io/text_clouds.h>

#include <charconv>

namespace pcl_bsh::io {

namespace {

using Fields = std::vector<pcl::PCLPointField>;

void appendNumber(std::string& text, std::uint8_t datatype, const char* bytes)
{
  withFieldType(datatype, [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  });
}

/// A line per point: `begin`, then its numbers.
void writeRows(std::ostream& out, const pcl::PCLPointCloud2& cloud, const Fields& fields, std::string_view begin)
{
  std::string lines;
  forEachPackedBlock(cloud, fields, Lists::bare, [&](std::string_view block) {
    lines.clear();
    for (const char* value = block.data(); value != block.data() + block.size();) {
      lines += begin;
      for (const pcl::PCLPointField& field : fields) {
        if (&field != fields.data()) lines += ' ';
        appendNumber(lines, field.datatype, value);
        value += sizeOf(field);
      }
      lines += '\n';
    }
    out << lines;
  });
}

} // namespace

void writeColumns(std::ostream& out, const pcl::PCLPointCloud2& cloud)
{
  const Fields fields = namedFields(cloud);
  std::string names;
  for (const pcl::PCLPointField& field : fields) {
    if (field.count > 1) {
      throw FormatError("field '" + field.name + "' has " + std::to_string(field.count) + " values per point",
                        "write a .pcd instead");
    }
    if (isNumber(field.name) || field.name.find_first_of("#,;") != std::string::npos || field.name.starts_with("//")) {
      throw FormatError("field '" + field.name + "' cannot name a column", "rename the field");
    }
    names += (names.empty() ? "" : " ") + field.name;
  }
  out << names << '\n';
  writeRows(out, cloud, fields, "");
}

void writeObj(std::ostream& out, const pcl::PCLPointCloud2& cloud)
{
  Fields vertex(3);
  for (const pcl::PCLPointField& field : namedFields(cloud)) {
    const std::size_t axis = std::string_view("xyz").find(field.name);
    if (field.name.size() != 1 || axis == std::string_view::npos) {
      throw FormatError("field '" + field.name + "' has no place in an .obj", "write a .pcd instead");
    }
    vertex[axis] = field;
  }
  writeRows(out, cloud, vertex, "v ");
}

} // namespace pcl_bsh::io
