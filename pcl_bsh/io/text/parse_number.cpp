// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/parse_number.h>

#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

namespace pcl_bsh::io {

bool isBelowOne(std::string_view digits)
{
  constexpr long long far = 1'000'000'000'000; // beyond any exponent that a file has room to make up for
  const std::size_t at = std::min(digits.find_first_of("eE"), digits.size());
  long long exponent = 0;
  if (at < digits.size()) {
    const std::string_view text = digits.substr(at + 1 + (digits.substr(at + 1).starts_with('+') ? 1 : 0));
    if (std::from_chars(text.data(), text.data() + text.size(), exponent).ec == std::errc::result_out_of_range) {
      exponent = text.starts_with('-') ? -far : far;
    }
    exponent = std::clamp(exponent, -far, far);
  }
  const std::string_view mantissa = digits.substr(0, at);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return true;
  // The power of ten of the first digit that counts.
  const long long power = static_cast<long long>(point) - static_cast<long long>(first) - (first < point ? 1 : 0);
  return power + exponent < 0;
}

std::optional<double> notFiniteNumber(std::string_view digits)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  constexpr std::size_t longest = 64; // Microsoft's C fills up with zeros to the digits asked for
  const bool negative = digits.starts_with('-');
  if (negative) digits.remove_prefix(1);
  if (digits.size() > longest) return std::nullopt;
  const std::string word = inSmallLetters(std::string(digits));
  for (const char* name : {"nanq", "nans", "qnan", "snan"})
    if (word == name) return nan;
  constexpr std::string_view mark = "1.#";
  if (!word.starts_with(mark)) return std::nullopt;
  std::string_view rest = std::string_view(word).substr(mark.size());
  rest = rest.substr(0, rest.find_last_not_of('0') + 1);
  if (rest == "inf") return negative ? -infinity : infinity;
  constexpr std::array said = {"ind", "nan", "qnan", "snan", "io", "j", "qnb", "qo", "r", "snb", "so", "t"};
  return std::find(said.begin(), said.end(), rest) != said.end() ? std::optional(nan) : std::nullopt;
}

FormatError noNumber(std::string_view word, bool whole)
{
  const std::string wrong = "'" + std::string(word.substr(0, 40)) + "' is not ";
  const bool commented = word.find('#') != std::string_view::npos;
  const bool mixed = word.find_first_of(",; \t") != std::string_view::npos;
  return FormatError(wrong + (whole ? "a whole number in the range of its type" : "a number"),
                     mixed       ? "write a decimal point, and one separator in all lines"
                     : commented ? "put a blank before a comment"
                                 : remedy_for_damage);
}

bool looksLikeNumber(std::string_view word)
{
  const std::size_t digit = std::min(word.find_first_not_of("+-."), word.size());
  return isNumber(word) || (digit < word.size() && word[digit] >= '0' && word[digit] <= '9');
}

} // namespace pcl_bsh::io
