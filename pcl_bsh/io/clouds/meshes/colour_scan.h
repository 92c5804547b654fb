// SPDX-License-Identifier: BSD-3-Clause
// Which colours the vertices of a mesh file (.obj, .off) have, seen over all of them before the first is stored.
#pragma once

#include <pcl_bsh/io/text/parse_number.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

namespace pcl_bsh::io {

/// Three or four numbers of a vertex line: whole ones from 0 to 255, or shares of 1.
class ColourScan {
public:
  /// How the numbers are stored: a byte each, given as such; a byte each, given as a share of 1; as they are.
  enum class Kind : std::uint8_t { bytes, shares, as_given };

  /// @param words of a vertex line, less its coordinates; no colour unless they are three or four
  void see(std::span<const std::string_view> words)
  {
    if (words.size() < 3 || words.size() > 4) return;
    channels_ = std::max(channels_, words.size());
    for (const std::string_view word : words) {
      const double value = numberOf<double>(word).value_or(-1); // no number: is refused when it is read
      if (!numberOf<std::uint8_t>(word)) bytes_ = false;
      constexpr double three_digits = 0.15; // how far a 255th written with three digits is from a whole one
      if (!(value >= 0 && value <= 1 && std::abs(value * 255 - std::round(value * 255)) <= three_digits))
        shares_ = false;
    }
  }

  std::size_t channels() const { return channels_; } ///< 0: no vertex has a colour

  Kind kind() const
  {
    if (shares_) return Kind::shares;
    return bytes_ ? Kind::bytes : Kind::as_given;
  }

private:
  std::size_t channels_ = 0;
  bool bytes_ = true;
  bool shares_ = true;
};

} // namespace pcl_bsh::io
