// SPDX-License-Identifier: BSD-3-Clause
// Compares a header's counts with what the file has: all formats say a difference alike.
#pragma once

#include <pcl_bsh/io/text/format_error.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

class TextCursor;

/// A count in a header.
struct HeaderCount {
  std::uint64_t told = 0;
  std::string one = "point", many = "points"; ///< nouns
};

/// The error where these differ.
FormatError otherCount(const HeaderCount& count, std::uint64_t there);

/// Refuses a file with fewer than its header counts. @throws FormatError
void requireNoFewer(const HeaderCount& count, std::uint64_t there);

/// Refuses a file with more, of which some would not be read. @throws FormatError
void requireNoMore(const HeaderCount& count, std::uint64_t there);

/// Refuses more lines with a word behind the last that is counted; takes them. @throws FormatError
void requireNoMoreLines(const HeaderCount& count, TextCursor& text);

/// Refuses bytes behind the last record that is counted: as many as another has, or more.
/// @param left how many there are
/// @param record bytes of one; at least, where `exact` is false
/// @throws FormatError
void requireNoMoreBytes(const HeaderCount& count, std::uint64_t left, std::uint64_t record, bool exact = true);

/// A sentence on such bytes for users, of a format whose files may have something else there: zeros are padding, as PCL
/// writes them.
/// @param first of the bytes that are left: most_padding of them, or all
std::optional<std::string> remarkOnMoreBytes(const HeaderCount& count, std::uint64_t left, std::string_view first,
                                             std::uint64_t record);

inline constexpr std::size_t most_padding = std::size_t{1} << 16; ///< bytes that are looked at

/// For a format whose readers take all that is there: one sentence where the header counts another number.
std::optional<std::string> remarkOnCount(const HeaderCount& count, std::uint64_t there);

} // namespace pcl_bsh::io
