// SPDX-License-Identifier: BSD-3-Clause
// Lines of numbers, read fast.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace pcl_bsh::io {

/// Reads a line of exactly as many numbers as there are values, and its end. A line that is anything else (a name, a
/// comment, nothing, a number with '+' or out of range) is for TextCursor, which knows what it is.
/// @param separator one such character, and blanks, stand between numbers; ' ': blanks and tabs
/// @return the bytes read; 0 when it is another line
std::size_t readNumberLine(std::string_view text, char separator, std::span<double> values);

} // namespace pcl_bsh::io
