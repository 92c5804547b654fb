// SPDX-License-Identifier: BSD-3-Clause
// The values behind a PLY header, row by row, whatever their storage: begin() a row, take or skip its values, end() it.
// Both classes throw FormatError where values are missing, malformed or too many.
#pragma once

#include <pcl_bsh/io/clouds/lines/field_text.h>
#include <pcl_bsh/io/text/header_count.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string_view>

namespace pcl_bsh::io {

inline constexpr auto truncated_rows = "is truncated: it ends before the last row that its header promises";

/// The values behind an ascii header: a line per row.
class AsciiRows {
public:
  explicit AsciiRows(const TextCursor& header) : text_(header) {}

  void begin()
  {
    if (!text_.nextLine()) throw FormatError(truncated_rows);
  }
  void value(std::uint8_t datatype, std::uint8_t* out) { readNumber(text_, datatype, out); }
  void skip(std::uint8_t datatype, std::uint64_t count)
  {
    std::uint8_t ignored[sizeof(std::uint64_t)];
    for (std::uint64_t i = 0; i < count; ++i) value(datatype, ignored);
  }
  void end() const { text_.requireEndOfLine(); }

  /// Requires that no row follows. @param last what the header counts of the last element
  void requireNoMore(const HeaderCount& last, std::uint64_t, bool) { requireNoMoreLines(last, text_); }

  std::uint64_t bytesLeft() const { return text_.rest().size() + 1; } // the last line may lack its end
  static std::uint64_t leastBytes(std::uint8_t) { return 2; }         // a digit and a separator

private:
  TextCursor text_;
};

/// The values behind a binary header: nothing between them.
class BinaryRows {
public:
  BinaryRows(std::string_view bytes, std::endian order) : bytes_(bytes), swapped_(order != std::endian::native) {}

  void begin() {}
  void value(std::uint8_t datatype, std::uint8_t* out)
  {
    const std::string_view taken = take(sizeOf(datatype));
    if (swapped_) {
      std::reverse_copy(taken.begin(), taken.end(), out);
    }
    else {
      std::copy(taken.begin(), taken.end(), out);
    }
  }
  void skip(std::uint8_t datatype, std::uint64_t count) { take(count * sizeOf(datatype)); }
  void end() {}

  /// Requires that no row follows. @param record bytes of a row; the least that one has, where `exact` is false
  void requireNoMore(const HeaderCount& last, std::uint64_t record, bool exact) const
  {
    requireNoMoreBytes(last, bytes_.size(), record, exact);
  }

  std::uint64_t bytesLeft() const { return bytes_.size(); }
  static std::uint64_t leastBytes(std::uint8_t datatype) { return sizeOf(datatype); }

private:
  std::string_view take(std::uint64_t count)
  {
    if (count > bytes_.size()) throw FormatError(truncated_rows);
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  std::string_view bytes_;
  bool swapped_;
};

} // namespace pcl_bsh::io
