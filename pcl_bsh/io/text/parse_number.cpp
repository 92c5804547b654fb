// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/parse_number.h>

#include <algorithm>

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

bool looksLikeNumber(std::string_view word)
{
  const std::size_t digit = std::min(word.find_first_not_of("+-."), word.size());
  return isNumber(word) || (digit < word.size() && word[digit] >= '0' && word[digit] <= '9');
}

} // namespace pcl_bsh::io
