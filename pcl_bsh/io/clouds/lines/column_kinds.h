// SPDX-License-Identifier: BSD-3-Clause
// Columns of text that float64 does not hold: names, codes, times of day, time stamps of 19 digits.
#pragma once

#include <pcl_bsh/io/clouds/pcl_names.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <pcl/PCLPointCloud2.h>

#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// Goes to the next line that is no comment of the // kind. False when there is no such line.
bool nextRow(TextCursor& text);

/// Whether float64 keeps all digits of the number in a word.
bool float64Holds(std::string_view word);

/// Whether a field has the type of a column of words: INT8, with a count above 1. Each word ends with a zero.
bool isTextField(const pcl::PCLPointField& field);

/// Text of a record's field. @throws FormatError where its bytes are no text
std::string_view textOf(const pcl::PCLPointField& field, const char* bytes);

/// Whether a word can be written between separators and is read back unchanged. Between commas it may have commas or
/// semicolons, which need quotes. @param separator ' ': blanks
bool canBeColumn(std::string_view word, char separator);

/// Finds the columns that are not float64, except coordinates, colours and those that are not read. Whole numbers
/// beyond 2^53 are INT64 or UINT64. Words that are no number, or have more digits than float64 holds, are text, as wide
/// as the longest. The first 1000 rows, of the first 48 KiB, tell what a column is, and for texts all rows how wide.
struct ColumnKinds {
  /// @param rows at the first row
  /// @param whole false: these are not all rows
  /// @param values gets their types and counts
  /// @throws FormatError where texts would take much more room than the file, or where `whole` is false and further
  ///   rows may change the kinds
  ColumnKinds(const TextCursor& rows, bool whole, Fields& values);

  std::vector<std::string> remarks; ///< for users, on columns that are kept as text
  bool rows_tell = false;           ///< all rows tell how wide a field is
};

} // namespace pcl_bsh::io
