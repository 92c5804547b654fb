// SPDX-License-Identifier: BSD-3-Clause
// Numbers and texts as they stand in files, whatever language the program speaks.
#pragma once

#include <charconv>
#include <string>

namespace pcl_bsh::io {

/// The fewest digits that read back to the same bits; "nan" and "inf" for values that are not finite.
std::string numberText(double value);

/// The value in that format. @param digits significant digits for general, digits behind the point for fixed
std::string numberText(double value, std::chars_format format, int digits);

/// A text as a cell of CSV: in quotes where it needs them.
std::string csvText(const std::string& text);

} // namespace pcl_bsh::io
