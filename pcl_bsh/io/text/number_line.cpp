// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/number_line.h>

#include <fast_float/fast_float.h>

#include <cmath>

namespace pcl_bsh::io {

namespace {

/// Skips blanks, and tabs unless they separate numbers.
const char* skipBlanks(const char* at, const char* end, char separator)
{
  while (at != end && (*at == ' ' || (*at == '\t' && separator != '\t'))) ++at;
  return at;
}

} // namespace

std::size_t readNumberLine(std::string_view text, char separator, std::span<double> values)
{
  const char* const end = text.data() + text.size();
  const char* at = skipBlanks(text.data(), end, separator);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) {
      const char* const next = skipBlanks(at, end, separator);
      const bool separated = separator == ' ' ? next != at : next != end && *next == separator;
      if (!separated) return 0;
      at = separator == ' ' ? next : skipBlanks(next + 1, end, separator);
    }
    const auto [behind, error] = fast_float::from_chars(at, end, values[i]);
    if (error != std::errc() || std::isinf(values[i])) return 0;
    at = behind;
  }
  at = skipBlanks(at, end, ' ');
  if (at == end) return text.size();
  if (*at == '\r') ++at;
  const bool returned = at != text.data() && at[-1] == '\r';
  if (at != end && *at == '\n') return static_cast<std::size_t>(at + 1 - text.data());
  return returned ? static_cast<std::size_t>(at - text.data()) : 0;
}

} // namespace pcl_bsh::io
