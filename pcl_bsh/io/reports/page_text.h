// SPDX-License-Identifier: BSD-3-Clause
// Texts and numbers as they stand in pages.
#pragma once

#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/io/text/number_text.h>

#include <cmath>
#include <string>

namespace pcl_bsh::io {

/// Text of files and their names; the template escapes it. HTML has no control characters.
inline std::string plain(const std::string& text)
{
  std::string safe;
  for (const char c : validUtf8(text)) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      safe += "\xef\xbf\xbd"; // U+FFFD
    else
      safe += c;
  }
  return safe;
}

/// So many significant digits, and no exponent where that is readable.
inline std::string number(double value, int digits = 4)
{
  return numberText(value, std::chars_format::general, digits);
}

/// A coordinate: millimetres if the unit is a metre.
inline std::string coordinate(double value)
{
  return numberText(value, std::chars_format::fixed, 3);
}

/// The greatest of 1, 2 and 5 times a power of ten that is not above the wish. @param wish > 0
inline double roundLength(double wish)
{
  const double decade = std::pow(10.0, std::floor(std::log10(wish)));
  return decade * (wish / decade >= 5 ? 5 : wish / decade >= 2 ? 2 : 1);
}

} // namespace pcl_bsh::io
