// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/cloud_files/text_clouds.h>
#include <pcl_bsh/filters/cloud_files/text_rows.h>

#include <algorithm>
#include <cctype>

namespace pcl_bsh::io {

namespace {

using Words = std::vector<std::string>;

Words wordsOf(TextCursor line)
{
  Words words;
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
Words defaultNames(std::size_t columns)
{
  Words names = {"x", "y", "z"};
  for (std::size_t i = 4; i <= columns; ++i) names.push_back("column_" + std::to_string(i));
  return names;
}

/// A line without anything like a number is no point: it names the columns. Blanks within a name become '_'.
bool namesColumns(Words& words)
{
  if (words.empty() || std::any_of(words.begin(), words.end(), looksLikeNumber)) return false;
  for (std::string& word : words)
    std::replace_if(
        word.begin(), word.end(), [](char c) { return c == ' ' || c == '\t'; }, '_');
  return std::find(words.begin(), words.end(), "") == words.end();
}

/// The names that a comment before the first row gives: it has x, y and z among them, in any case of letters.
Words namesInComments(std::string_view file)
{
  for (TextCursor text(file); text.nextLine();) {
    const std::size_t marks = text.line().starts_with("//") ? 2 : text.line().starts_with('#') ? 1 : 0;
    if (marks == 0) break;
    TextCursor comment(text.line().substr(marks));
    if (!comment.nextLine()) continue;
    comment.separateBy(separatorOf(comment.line()));
    Words words = wordsOf(comment);
    const auto names = [&](char axis) {
      return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
        return word.size() == 1 && std::tolower(static_cast<unsigned char>(word[0])) == axis;
      });
    };
    if (names('x') && names('y') && names('z') && namesColumns(words)) return words;
  }
  return {};
}

struct Columns {
  Fields values;
  bool at_row = false; ///< the text is at the first point; false when there is none
};

/// Columns that all rows fill with whole numbers from 0 to 255 can be channels of a colour. The text is at the first
/// row, if there is one.
void findBytes(TextCursor text, bool at_row, Fields& values)
{
  using Field = pcl::PCLPointField;
  pcl::PCLPointCloud2 laid_out;
  for (Field& value : values) value.datatype = Field::UINT8;
  layOutForPcl(values, laid_out);
  const bool coloured = std::any_of(laid_out.fields.begin(), laid_out.fields.end(), isPackedColour);
  std::vector<bool> bytes(values.size(), coloured);
  for (at_row = at_row && coloured; at_row; at_row = nextRow(text)) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string_view word = text.word(); // empty where the row ends early
      if (bytes[i] && !isByte(word)) bytes[i] = false;
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i) values[i].datatype = bytes[i] ? Field::UINT8 : Field::FLOAT64;
  // Only packed columns are bytes: other columns of small numbers are float64, as all columns are.
  laid_out = {};
  const std::vector<std::uint32_t> offsets = layOutForPcl(values, laid_out);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto holds = [&](const Field& field) {
      return isPackedColour(field) && offsets[i] >= field.offset && offsets[i] < field.offset + 4;
    };
    if (std::none_of(laid_out.fields.begin(), laid_out.fields.end(), holds)) values[i].datatype = Field::FLOAT64;
  }
}

/// Goes to the first row.
Columns readColumns(TextCursor& text, std::string_view file)
{
  Words in_comments = namesInComments(file);
  Columns columns;
  columns.at_row = nextRow(text);
  text.separateBy(separatorOf(text.line()));
  Words words = wordsOf(text);
  if (columns.at_row && namesColumns(words)) {
    columns.at_row = nextRow(text);
    if (columns.at_row) text.separateBy(separatorOf(text.line()));
  }
  else if (columns.at_row && words.size() < 3) {
    text.fail("is no point: it has fewer than three numbers");
  }
  else if (in_comments.empty() || (columns.at_row && in_comments.size() != words.size())) {
    words = defaultNames(words.size());
    if (!columns.at_row) throw FormatError("holds no points", "give it a line of x y z per point");
  }
  else {
    words = std::move(in_comments);
  }
  for (const std::string& name : words) columns.values.push_back(textValue(name));
  findBytes(text, columns.at_row, columns.values);
  return columns;
}

} // namespace

pcl::PCLPointCloud2 parseColumnNames(std::string_view file)
{
  TextCursor text(file, '#');
  return TextRows(readColumns(text, file).values).finished();
}

pcl::PCLPointCloud2 parseColumns(std::string_view file)
{
  TextCursor text(file, '#');
  const Columns columns = readColumns(text, file);
  TextRows rows(columns.values);
  std::vector<double> numbers(columns.values.size());
  rows.reserveLines(text.rest());
  for (bool at_row = columns.at_row; at_row; at_row = nextRow(text)) {
    rows.add();
    rows.take(text, rows.size() - 1, 0, columns.values.size());
    text.requireEndOfLine();
    for (TextCursor row = text; row.nextNumbers(numbers) && rows.add(numbers);) text = row;
  }
  return std::move(rows).finished();
}

} // namespace pcl_bsh::io
