// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/lines/column_kinds.h>
#include <pcl_bsh/io/clouds/lines/field_text.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace pcl_bsh::io {

namespace {

/// A number of a line, and what stands before it.
struct TextValue {
  pcl::PCLPointField field;
  std::string before;
  bool share = false; ///< a byte, as a share of 1
  char text = 0;      ///< of a text: the separator of columns; 0: a number
};

void appendShare(std::string& text, std::uint8_t byte)
{
  std::array<char, 32> digits;
  constexpr int enough = 6; // digits, to tell 255ths apart
  const auto end = std::to_chars(digits.begin(), digits.end(), byte / 255.0, std::chars_format::general, enough).ptr;
  text.append(digits.begin(), end);
}

void appendText(std::string& line, const TextValue& value, const char* bytes)
{
  const std::string_view text = textOf(value.field, bytes);
  if (!canBeColumn(text, value.text))
    throw FormatError("field '" + value.field.name + "' has the text '" + std::string(text.substr(0, 40)) +
                          "', which cannot stand between separators",
                      value.text == ' ' ? "write a .csv or .pcd instead" : "write a .pcd instead");
  const bool quoted = text.find_first_of(",;") != std::string_view::npos;
  if (quoted) line += '"';
  line += text;
  if (quoted) line += '"';
}

void writeRows(std::ostream& out, const pcl::PCLPointCloud2& cloud, const std::vector<TextValue>& values)
{
  Fields fields;
  for (const TextValue& value : values) fields.push_back(value.field);
  std::string lines;
  forEachPackedBlock(cloud, fields, Lists::bare, [&](std::string_view block) {
    lines.clear();
    for (const char* bytes = block.data(); bytes != block.data() + block.size();) {
      for (const TextValue& value : values) {
        lines += value.before;
        if (value.text != 0) {
          appendText(lines, value, bytes);
        }
        else if (value.share) {
          appendShare(lines, static_cast<std::uint8_t>(*bytes));
        }
        else {
          appendNumber(lines, value.field.datatype, bytes);
        }
        bytes += sizeOf(value.field);
      }
      lines += '\n';
    }
    out << lines;
  });
}

/// The field of that name, with a count of 1. None where there is no such, or another of the same name.
const pcl::PCLPointField* onlyField(const Fields& fields, const char* name)
{
  const auto is_it = [&](const pcl::PCLPointField& field) { return field.name == name && field.count <= 1; };
  const auto found = std::find_if(fields.begin(), fields.end(), is_it);
  return std::count_if(fields.begin(), fields.end(), is_it) == 1 ? &*found : nullptr;
}

/// All fields of these names, or none unless all are there.
Fields allOf(const Fields& fields, const std::vector<const char*>& names)
{
  Fields found;
  for (const char* name : names) {
    const pcl::PCLPointField* const field = onlyField(fields, name);
    if (field == nullptr) return {};
    found.push_back(*field);
  }
  return found;
}

} // namespace

void writeColumns(std::ostream& out, const pcl::PCLPointCloud2& cloud, char separator)
{
  const std::string between(1, separator);
  const Fields fields = namedForFiles(namedFields(cloud), text_channels);
  std::vector<TextValue> values;
  for (const pcl::PCLPointField& field : fields) {
    if (field.count > 1 && !isTextField(field)) {
      throw FormatError("field '" + field.name + "' has " + counted(field.count, "value") + " per point",
                        "write a .pcd instead");
    }
    if (looksLikeNumber(field.name) || field.name.find_first_of("#,;\"") != std::string::npos ||
        field.name.starts_with("//") || field.name.starts_with(utf8_mark) || isUtf16(field.name)) {
      throw FormatError("field '" + field.name + "' cannot name a column", "rename the field");
    }
    out << (values.empty() ? "" : between) << field.name;
    values.push_back({field, values.empty() ? "" : between, false, isTextField(field) ? separator : '\0'});
  }
  out << '\n';
  writeRows(out, cloud, values);
}

Fields fieldsForObj(const pcl::PCLPointCloud2& cloud)
{
  Fields held;
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name == "x" || field.name == "y" || field.name == "z") held.push_back(field);
  }
  const auto colour = std::find_if(cloud.fields.begin(), cloud.fields.end(), isPackedColour);
  if (colour != cloud.fields.end()) held.push_back(*colour);
  const Fields normals = allOf(cloud.fields, {"normal_x", "normal_y", "normal_z"});
  held.insert(held.end(), normals.begin(), normals.end());
  return held;
}

void writeObj(std::ostream& out, const pcl::PCLPointCloud2& cloud)
{
  const Fields held = fieldsForObj(cloud);
  for (const pcl::PCLPointField& field : namedFields(cloud)) {
    if (std::none_of(held.begin(), held.end(), [&](const auto& other) { return other.name == field.name; })) {
      throw FormatError("field '" + field.name + "' has no place in an .obj", "write a .pcd instead");
    }
  }
  const Fields fields = namedForFiles(held, ply_channels);
  std::vector<TextValue> values;
  const char* before = "vn ";
  for (const pcl::PCLPointField& field : allOf(fields, {"nx", "ny", "nz"})) {
    values.push_back({field, before});
    before = " ";
  }
  before = values.empty() ? "v " : "\nv ";
  for (const pcl::PCLPointField& field : allOf(fields, {"x", "y", "z"})) {
    values.push_back({field, before});
    before = " ";
  }
  if (before[0] != ' ') throw FormatError("the cloud has not one each of x, y and z", "write a cloud with x y z");
  for (const char* channel : ply_channels) {
    if (const pcl::PCLPointField* const field = onlyField(fields, channel)) values.push_back({*field, " ", true});
  }
  out << "# Vertices: " << std::to_string(std::uint64_t{cloud.width} * cloud.height) << '\n';
  writeRows(out, cloud, values);
}

} // namespace pcl_bsh::io
