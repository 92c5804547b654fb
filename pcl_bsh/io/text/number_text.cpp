// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/number_text.h>

#include <array>

namespace pcl_bsh::io {

namespace {

constexpr std::size_t most_digits = 400; // a double in full has 309 before its point

} // namespace

std::string numberText(double value)
{
  std::array<char, most_digits> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string numberText(double value, std::chars_format format, int digits)
{
  std::array<char, most_digits> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, format, digits).ptr};
}

std::string csvText(const std::string& text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string(2, '"') : std::string(1, c);
  return quoted + '"';
}

} // namespace pcl_bsh::io
