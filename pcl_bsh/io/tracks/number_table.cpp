// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/number_table.h>

#include <pcl_bsh/io/text/small_letters.h>

#include <pcl_bsh/base/counted.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::io {
namespace {

std::vector<std::string_view> wordsOf(TextCursor line)
{
  line.separateBy(separatorOf(line.line()));
  std::vector<std::string_view> words;
  while (!line.line().empty()) words.push_back(line.word());
  return words;
}

constexpr std::size_t no_column = std::numeric_limits<std::size_t>::max();

std::vector<std::size_t> columnsNamed(const TextCursor& line, const std::vector<TableColumn>& columns)
{
  std::vector<std::string> names;
  for (const std::string_view word : wordsOf(line)) names.push_back(inSmallLetters(std::string(word)));
  std::vector<std::size_t> found;
  for (const TableColumn& column : columns) {
    std::size_t at = no_column;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (std::find(column.names.begin(), column.names.end(), names[i]) == column.names.end()) continue;
      if (at != no_column) line.fail("names the column " + names[i] + " twice", "leave one of them out");
      at = i;
    }
    if (at == no_column && column.required)
      line.fail("names no column " + column.names.front(), "name the columns in the first line");
    found.push_back(at);
  }
  return found;
}

} // namespace

NumberTable numberTable(std::string_view text, const std::vector<TableColumn>& columns, bool unnamed)
{
  NumberTable table;
  TextCursor cursor(text, '#');
  if (!cursor.nextLine()) throw FormatError("holds no line", "give a line for each point");
  const std::vector<std::string_view> first = wordsOf(cursor);
  const bool named = std::none_of(first.begin(), first.end(), looksLikeNumber);
  std::vector<std::size_t> at;
  if (named) {
    at = columnsNamed(cursor, columns);
  }
  else {
    if (!unnamed)
      cursor.fail("names no columns", "name them in the first line, " + columns.front().names.front() + " among them");
    for (std::size_t i = 0; i < columns.size(); ++i) at.push_back(i);
  }
  const std::size_t count = first.size();
  if (named && !cursor.nextLine()) return table;
  do {
    const std::vector<std::string_view> words = wordsOf(cursor);
    if (words.size() != count)
      cursor.fail("has " + counted(words.size(), "value") + ", and the first line has " + std::to_string(count),
                  "give a value for each column");
    std::vector<double> row;
    for (const std::size_t column : at) {
      const bool absent = column >= words.size();
      if (absent && !named) cursor.fail("has " + counted(count, "column"), "give " + std::to_string(columns.size()));
      row.push_back(absent ? std::numeric_limits<double>::quiet_NaN()
                           : cursor.naming([&] { return parseNumber<double>(words[column]); }));
    }
    table.rows.push_back(std::move(row));
    table.lines.push_back(cursor);
  } while (cursor.nextLine());
  return table;
}

} // namespace pcl_bsh::io
