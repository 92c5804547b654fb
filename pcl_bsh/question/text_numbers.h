// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
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

} // namespace pcl_bsh
