// SPDX-License-Identifier: BSD-3-Clause
// Meaning of the columns of a text file: as users say, as a line of the file says, or as their numbers show.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The columns' names in their order. Empty: not given.
using ColumnNames = std::vector<std::string>;

inline constexpr std::string_view skipped_column = "_"; ///< the name of a column that is not read; PCL names padding so

/// Names as users give them: `x,y,z,intensity`, `_` for a column that is not read.
/// @throws FormatError where one is empty or is given twice
ColumnNames columnNamesOf(std::string_view text);

/// Renames surveyors' names to x, y and z, in any case of letters: E, East, Easting; N, North, Northing; H, Height,
/// Elevation, Elev, Altitude. An axis that has its own name, or two of these, stays as it is.
ColumnNames withAxes(ColumnNames names);

/// Whether files of that extension, with its dot and in small letters, are columns of text.
bool isColumnText(std::string_view extension);

/// The columns of several files, as a program's user gives them.
class ColumnChoice {
public:
  /// @param text `x,y,z` for all columns of text, or `FILE=x,y,z` for that file
  /// @throws FormatError as columnNamesOf() does, and for a file that is given twice
  void add(const std::string& text);

  /// Returns the names given for that file. Without them, returns the names given for all files, if the file is columns
  /// of text or a pipe.
  ColumnNames of(const std::filesystem::path& file) const;

  /// @throws FormatError where names are given for a file that is not among these, or for all files and none of these
  ///   is columns of text or a pipe
  void requireUsed(const std::vector<std::filesystem::path>& files) const;

private:
  std::optional<ColumnNames> all_;
  std::map<std::filesystem::path, ColumnNames> files_;
};

} // namespace pcl_bsh::io
