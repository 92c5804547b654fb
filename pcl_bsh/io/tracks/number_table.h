// SPDX-License-Identifier: BSD-3-Clause
// A text of numbers in named columns.
#pragma once

#include <pcl_bsh/io/text/text_cursor.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// Rows of the columns that are asked for, and where they stand.
struct NumberTable {
  std::vector<std::vector<double>> rows; ///< a value per column; NaN for one that may be absent, and is
  std::vector<TextCursor> lines;         ///< of each row, before its first word: it can say what is wrong there
};

/// A column, by any of its names in small letters.
struct TableColumn {
  std::vector<std::string> names;
  bool required = true;
};

/// The first line names the columns. Where it is numbers, `unnamed` says what they are, or that is an error.
/// @throws FormatError naming the line and the column
NumberTable numberTable(std::string_view text, const std::vector<TableColumn>& columns, bool unnamed);

} // namespace pcl_bsh::io
