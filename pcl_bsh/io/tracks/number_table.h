// SPDX-License-Identifier: BSD-3-Clause
// A text of numbers in named columns.
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// Rows of the columns that are asked for, and where they stand.
struct NumberTable {
  std::vector<std::vector<double>> rows; ///< a value per column; NaN for one that may be absent, and is
  std::vector<TextCursor> lines;         ///< cursors before the first word of each row, to name the line in errors
};

/// A column, by any of its names in small letters.
struct TableColumn {
  std::vector<std::string> names;
  bool required = true;
};

/// Coordinates, as files name them.
inline const TableColumn x_column = {{"x", "e", "east", "easting"}}, y_column = {{"y", "n", "north", "northing"}},
                         z_column = {{"z", "h", "height", "elevation"}};

/// Reads columns, which the first line names. A first line of numbers is a row, and columns are in the order of
/// `columns` then. It is refused unless `unnamed` is true.
/// @throws FormatError naming the line and the column
NumberTable numberTable(std::string_view text, const std::vector<TableColumn>& columns, bool unnamed);

/// The result of `read`; its errors name the file. @param form advice on the form of such files, for errors without
/// advice of their own
template <class Read>
auto namingFile(const std::filesystem::path& path, const char* form, const Read& read)
{
  try {
    return read();
  }
  catch (const FormatError& error) {
    throw files::FileError(path, error.what(), error.remedy() == remedy_for_damage ? form : error.remedy());
  }
  catch (const InvalidInput& error) {
    throw files::FileError(path, error.wrong(), error.remedy());
  }
}

} // namespace pcl_bsh::io
