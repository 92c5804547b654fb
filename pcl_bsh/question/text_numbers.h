// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh {

/// Parts of a text between separators; one at least.
inline std::vector<std::string_view> partsOf(std::string_view text, char separator)
{
  std::vector<std::string_view> parts;
  for (std::size_t at = text.find(separator); at != std::string_view::npos; at = text.find(separator)) {
    parts.push_back(text.substr(0, at));
    text.remove_prefix(at + 1);
  }
  parts.push_back(text);
  return parts;
}

/// Finite numbers with commas between them; none where anything else is there.
inline std::optional<std::vector<double>> numbersOf(std::string_view text)
{
  std::vector<double> numbers;
  for (const std::string_view part : partsOf(text, ',')) {
    double number = 0.0;
    const char* const end = part.data() + part.size();
    const auto [stop, error] = std::from_chars(part.data(), end, number);
    if (error != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

/// Numbers with commas between them, each with the fewest digits that read back to the same bits.
template <class... Numbers>
std::string textOfNumbers(const Numbers&... numbers)
{
  std::string text;
  const auto add = [&text](double number) {
    char digits[32];
    text.append(text.empty() ? "" : ",").append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
  };
  (add(numbers), ...);
  return text;
}

} // namespace pcl_bsh
