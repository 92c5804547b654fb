// SPDX-License-Identifier: BSD-3-Clause
// Numbers read from text.
#pragma once

#include <pcl_bsh/io/text/format_error.h>

#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>

namespace pcl_bsh::io {

/// Whether decimal digits, which say a number that is too large or too small for its type, say one below 1. Not left to
/// the C library, for it reads a decimal comma where the program's language has one.
bool isBelowOne(std::string_view digits);

/// The number nearest to what the word says.
/// @throws FormatError when it says no number, or one that T cannot hold
template <typename T>
T parseNumber(std::string_view word)
{
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  T value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (error == std::errc::result_out_of_range && std::is_floating_point_v<T> && whole && isBelowOne(digits)) {
    return T{0}; // too large is an error; too small is zero
  }
  if (error != std::errc() || !whole) {
    const std::string wrong = "'" + std::string(word.substr(0, 40)) + "' is not ";
    const bool mixed = word.find_first_of(",; \t") != std::string_view::npos;
    throw FormatError(wrong + (std::is_floating_point_v<T> ? "a number" : "a whole number in the range of its type"),
                      mixed ? "write a decimal point, and one separator in all lines" : remedy_for_damage);
  }
  return value;
}

/// Whether the word says a number.
inline bool isNumber(std::string_view word)
{
  try {
    parseNumber<double>(word);
    return true;
  }
  catch (const FormatError&) {
    return false;
  }
}

/// Whether the word is a number or meant for one, as with a decimal comma: it cannot be a name.
bool looksLikeNumber(std::string_view word);

} // namespace pcl_bsh::io
