// SPDX-License-Identifier: BSD-3-Clause
// Numbers read from text.
#pragma once

#include <pcl_bsh/io/text/format_error.h>

#include <charconv>
#include <optional>
#include <string_view>
#include <type_traits>

namespace pcl_bsh::io {

/// Whether the absolute value of a decimal number is below 1: a number out of its type's range is then too small, else
/// too large. The C library is not asked, because it reads a decimal comma where the program's language has one.
bool isBelowOne(std::string_view digits);

/// The value of a word that says NaN or infinity where from_chars() reads none: 1.#QNAN, -1.#IND, 1.#SNAN, 1.#INF0 and
/// what their rounding leaves (1.#QO, 1.#R, 1.#J), of Microsoft's C; NaNQ, NaNS, QNAN, SNAN; in any case of letters.
/// `1.#INF...` is infinity, all others are NaN.
/// @param digits without a leading '+'
std::optional<double> notFiniteNumber(std::string_view digits);

/// The number nearest to what the word says; none when it says no number, or one that T cannot hold. Each word of a
/// text becomes a number here, or by readNumberLine(), which reads fewer forms of numbers.
template <typename T>
std::optional<T> numberOf(std::string_view word)
{
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  T value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (error == std::errc() && whole) return value;
  if constexpr (std::is_floating_point_v<T>) {
    const bool tiny = error == std::errc::result_out_of_range && whole && isBelowOne(digits);
    if (tiny) return T{0}; // too large is an error; too small is zero
    if (const auto special = notFiniteNumber(digits)) return static_cast<T>(*special);
  }
  return std::nullopt;
}

/// The error in a word that says no number. @param whole a whole number was meant
FormatError noNumber(std::string_view word, bool whole);

/// The number of numberOf(). @throws FormatError where there is no number
template <typename T>
T parseNumber(std::string_view word)
{
  if (const std::optional<T> value = numberOf<T>(word)) return *value;
  throw noNumber(word, !std::is_floating_point_v<T>);
}

/// Whether the word says a number.
inline bool isNumber(std::string_view word)
{
  return numberOf<double>(word).has_value();
}

/// Whether the word is a number or meant for one, as with a decimal comma: it cannot be a name.
bool looksLikeNumber(std::string_view word);

} // namespace pcl_bsh::io
