// SPDX-License-Identifier: BSD-3-Clause
// A field's values in a text.
#pragma once

#include <pcl_bsh/io/clouds/field_type.h>
#include <pcl_bsh/io/text/parse_number.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

/// Writes the number that the word says to `out`, in the representation of `datatype`. Throws as parseNumber() does.
inline void parseNumber(std::string_view word, std::uint8_t datatype, std::uint8_t* out)
{
  withFieldType(datatype, [&](auto zero) {
    const auto value = parseNumber<decltype(zero)>(word);
    std::memcpy(out, &value, sizeof value);
  });
}

/// Takes the next word of the line as a number and writes it so.
/// @throws FormatError naming the line
inline void readNumber(TextCursor& text, std::uint8_t datatype, std::uint8_t* out)
{
  text.parseWord([&](std::string_view word) { parseNumber(word, datatype, out); });
}

/// Appends the number of that type that begins at `bytes`, with as few digits as tell it from others of its type.
inline void appendNumber(std::string& text, std::uint8_t datatype, const char* bytes)
{
  withFieldType(datatype, [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    std::array<char, 32> digits;
    text.append(digits.begin(), std::to_chars(digits.begin(), digits.end(), value).ptr);
  });
}

} // namespace pcl_bsh::io
