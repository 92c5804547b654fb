// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/lines/column_kinds.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>
#include <pcl_bsh/io/clouds/lines/text_rows.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/text/header_count.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace pcl_bsh::io {

namespace {

using Words = std::vector<std::string>;

Words wordsOf(TextCursor line)
{
  Words words;
  while (!line.line().empty()) words.emplace_back(line.word());
  return words;
}

constexpr std::size_t most_columns_of_example = 16;
constexpr auto name_the_columns = "name the columns (--columns of programs, columns of readers), as ";

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
  if (std::any_of(words.begin(), words.end(), looksLikeNumber)) return false;
  for (std::string& word : words)
    std::replace_if(
        word.begin(), word.end(), [](char c) { return c == ' ' || c == '\t'; }, '_');
  return std::find(words.begin(), words.end(), "") == words.end();
}

bool namesAxis(const Words& names, char axis)
{
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return inSmallLetters(name) == std::string(1, axis); });
}

/// The names that a comment before the first row gives: it has x, y and z among them, or what stands for them.
Words namesInComments(std::string_view file)
{
  for (TextCursor text(file); text.nextLine();) {
    const std::size_t marks = text.line().starts_with("//") ? 2 : text.line().starts_with('#') ? 1 : 0;
    if (marks == 0) break;
    TextCursor comment(text.line().substr(marks));
    if (!comment.nextLine()) continue;
    comment.separateBy(separatorOf(comment.line()));
    Words words = wordsOf(comment);
    const Words axes = withAxes(words);
    if (namesAxis(axes, 'x') && namesAxis(axes, 'y') && namesAxis(axes, 'z') && namesColumns(words)) return words;
  }
  return {};
}

struct Columns {
  Fields values;
  bool at_row = false;                   ///< the text is at the first point; false when there is no point
  bool rows_tell = false;                ///< the values depend on all rows
  bool named = true;                     ///< not by their numbers
  std::optional<std::uint64_t> promised; ///< points, by a line of its own
  std::vector<std::string> remarks;
};

/// Calls `use` with the numbers of each row, from this one on, until it returns false. A word that is not a number
/// becomes NaN.
template <typename Use>
void forEachRow(TextCursor text, std::size_t columns, const Use& use)
{
  std::vector<double> numbers(columns);
  do {
    for (double& number : numbers)
      number = numberOf<double>(text.word()).value_or(std::numeric_limits<double>::quiet_NaN());
    if (!use(numbers)) return;
    while (text.nextNumbers(numbers))
      if (!use(numbers)) return;
  } while (nextRow(text));
}

/// The kinds of columns without names, as their numbers show them.
class ShownColumns {
public:
  explicit ShownColumns(std::size_t columns) : counts_(columns > 3), coloured_(columns >= 6), normals_(columns >= 9) {}

  /// @return whether another row may tell more
  bool see(const std::vector<double>& row)
  {
    counts_ = counts_ && std::trunc(row[0]) == row[0] && (rows_ == 0 || row[0] == previous_ + 1);
    previous_ = row[0];
    ++rows_;
    for (std::size_t k = 0; coloured_ && k < 3; ++k) {
      coloured_ = isByte(row[3 + k]);
      greatest_[k] = std::max(greatest_[k], row[3 + k]);
    }
    if (coloured_ && normals_) {
      const double* const n = row.data() + row.size() - 3;
      const double length = std::hypot(n[0], n[1], n[2]);
      constexpr double few_digits = 1e-3;
      normals_ = length == 0 || std::abs(length - 1) <= few_digits;
    }
    return counts_ || coloured_;
  }

  bool counts() const { return counts_ && rows_ > 2; } ///< the first column, by one
  bool mayBeColoured() const { return coloured_; }     ///< by the rows so far
  bool isColoured() const
  {
    constexpr double greatest_class = 31;
    return coloured_ && *std::min_element(greatest_.begin(), greatest_.end()) > greatest_class;
  }
  bool hasNormals() const { return normals_; }

private:
  bool counts_, coloured_, normals_;
  std::array<double, 3> greatest_ = {};
  double previous_ = 0;
  std::size_t rows_ = 0;
};

/// x y z column_4 column_5 ..., or r g b and normals where the numbers leave no doubt. The text is at the first row.
void nameByNumbers(const TextCursor& text, Words& names, Columns& columns)
{
  const std::size_t count = names.size();
  names = defaultNames(count);
  ShownColumns shown(count);
  forEachRow(text, count, [&](const std::vector<double>& row) { return shown.see(row); });
  columns.rows_tell = shown.mayBeColoured();
  if (shown.counts()) {
    std::string example = "_,x,y,z";
    for (std::size_t i = 4; i < count; ++i) example += ",_";
    columns.remarks.push_back("its first column counts up by one, and is taken for x: if it numbers the points, " +
                              std::string(name_the_columns) + example);
  }
  if (!shown.isColoured()) return;
  std::copy(text_channels.begin(), text_channels.begin() + 3, names.begin() + 3);
  std::string assumed = "no line names its columns: 4 to 6, whole numbers from 0 to 255, are taken for r g b";
  std::string example = "x,y,z,r,g,b";
  if (shown.hasNormals()) {
    for (std::size_t k = 0; k < 3; ++k) names[count - 3 + k] = std::string("n") + "xyz"[k];
    assumed += ", and the last three, of length 1, for nx ny nz";
  }
  for (std::size_t i = 6; i < count; ++i) example += ',' + names[i];
  columns.remarks.push_back(assumed + ": if they are something else, " + name_the_columns + example);
}

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
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i].count == 0) bytes[i] = false;
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
  const auto colour = std::find_if(laid_out.fields.begin(), laid_out.fields.end(), isPackedColour);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool held =
        colour != laid_out.fields.end() && offsets[i] >= colour->offset && offsets[i] < colour->offset + 4;
    if (!held) values[i].datatype = Field::FLOAT64;
  }
}

void requireAxes(const Words& given)
{
  const Words names = withAxes(given);
  for (const char axis : {'x', 'y', 'z'}) {
    if (namesAxis(names, axis)) continue;
    std::string all;
    for (const std::string& name : given) all += ' ' + name;
    throw FormatError("its columns are named" + all + ": none of them is " + axis,
                      std::string(name_the_columns) + "x,y,z,_");
  }
}

/// Takes a line that counts the points, as CloudCompare writes it before the first of them. The text is at a row, if
/// `columns` says so.
void takeCount(TextCursor& text, Columns& columns)
{
  if (!columns.at_row || columns.promised) return;
  TextCursor line = text;
  const auto count = numberOf<std::uint64_t>(line.word());
  if (!count || !line.line().empty()) return;
  columns.promised = count;
  columns.at_row = nextRow(text);
}

/// An example of names for all columns, with `_` for columns that are no numbers. Empty where all columns are numbers.
std::string exampleOf(TextCursor row, const Columns& columns)
{
  std::string example;
  std::size_t axes = 0;
  bool words = false;
  for (std::size_t i = 0; i < std::min(columns.values.size(), most_columns_of_example) && !row.line().empty(); ++i) {
    const bool number = isNumber(row.word());
    std::string name(skipped_column);
    if (number && columns.named)
      name = columns.values[i].name;
    else if (number)
      name = axes < 3 ? std::string(1, "xyz"[axes++]) : "column_" + std::to_string(i + 1);
    words = words || !number;
    example += (i > 0 ? "," : "") + name;
  }
  return words ? example : "";
}

/// Goes to the first row. @param whole whether the file is all there
Columns readColumns(TextCursor& text, std::string_view file, bool whole, const ColumnNames& given)
{
  Words in_comments = namesInComments(file);
  Columns columns;
  columns.at_row = nextRow(text);
  takeCount(text, columns);
  text.separateBy(separatorOf(text.line()));
  Words words = wordsOf(text);
  const std::size_t count = words.size();
  const bool lined = columns.at_row, headed = lined && namesColumns(words);
  if (lined && !given.empty() && given.size() != count)
    text.fail("has " + counted(count, "value") + ", and names of " + counted(given.size(), "column") + " are given",
              "name all columns: _ for one that is not read");
  if (headed) {
    columns.at_row = nextRow(text);
    takeCount(text, columns);
    if (columns.at_row) text.separateBy(separatorOf(text.line()));
  }
  else if (lined && count < 3) {
    text.fail("is no point: it has fewer than three numbers");
  }
  else if (!in_comments.empty() && (!lined || in_comments.size() == count)) {
    words = std::move(in_comments);
  }
  else if (!lined) {
    throw FormatError("holds no points", "give it a line of x y z per point");
  }
  else if (given.empty()) {
    nameByNumbers(text, words, columns);
    columns.named = false;
  }
  if (!given.empty()) words = given;
  requireAxes(words);
  for (const std::string& name : withAxes(words)) {
    columns.values.push_back(textValue(name));
    if (name == skipped_column) columns.values.back().count = 0;
  }
  findBytes(text, columns.at_row, columns.values);
  for (const pcl::PCLPointField& value : columns.values)
    if (value.datatype == pcl::PCLPointField::UINT8) columns.rows_tell = true;
  if (columns.at_row) {
    const ColumnKinds kinds(text, whole, columns.values);
    columns.rows_tell = columns.rows_tell || kinds.rows_tell;
    columns.remarks.insert(columns.remarks.end(), kinds.remarks.begin(), kinds.remarks.end());
  }
  return columns;
}

} // namespace

pcl::PCLPointCloud2 parseColumnNames(std::string_view file, bool whole, const ColumnNames& given)
{
  if (!whole) file = file.substr(0, file.find_last_of("\r\n") + 1); // no part of a row
  TextCursor text(file, '#');
  const Columns columns = readColumns(text, file, whole, given);
  if (!whole && columns.rows_tell) throw FormatError("is known in part, and all of its rows tell what they are");
  return TextRows(columns.values).finished();
}

pcl::PCLPointCloud2 parseColumns(std::string_view file, const ColumnNames& given, std::vector<std::string>* remarks)
{
  TextCursor text(file, '#');
  const Columns columns = readColumns(text, file, true, given);
  if (remarks) remarks->insert(remarks->end(), columns.remarks.begin(), columns.remarks.end());
  TextRows rows(columns.values);
  std::vector<double> numbers(columns.values.size());
  rows.reserveLines(text.rest());
  for (bool at_row = columns.at_row; at_row; at_row = nextRow(text)) {
    rows.add();
    const TextCursor row_begins = text;
    try {
      rows.take(text, rows.size() - 1, 0, columns.values.size());
    }
    catch (const FormatError& error) {
      const std::string example = exampleOf(row_begins, columns);
      if (error.remedy() != remedy_for_damage || example.empty()) throw;
      throw FormatError(error.what(), "where a column holds no numbers, " + std::string(name_the_columns) + example +
                                          ": _ is not read");
    }
    text.requireEndOfLine();
    for (TextCursor row = text; rows.takesDoubles() && row.nextNumbers(numbers) && rows.add(numbers);) text = row;
  }
  if (columns.promised) {
    requireNoFewer({*columns.promised}, rows.size());
    const auto more = remarkOnCount({*columns.promised}, rows.size());
    if (remarks && more) remarks->push_back(*more);
  }
  return std::move(rows).finished();
}

} // namespace pcl_bsh::io
