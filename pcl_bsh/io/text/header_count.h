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

/// The error that tells both numbers, which differ.
FormatError otherCount(const HeaderCount& count, std::uint64_t there);

/// Refuses a file with fewer than its header counts. @throws FormatError
void requireNoFewer(const HeaderCount& count, std::uint64_t there);

/// Refuses a file with more, of which some would not be read. @throws FormatError
void requireNoMore(const HeaderCount& count, std::uint64_t there);

/// Refuses lines with a word behind the last line that is counted. Reads the text to its end. @throws FormatError
void requireNoMoreLines(const HeaderCount& count, TextCursor& text);

/// Refuses bytes behind the last record that is counted, if they are enough for another record.
/// @param left how many bytes are behind it
/// @param record bytes of a record; the least that one has, where `exact` is false
/// @throws FormatError
void requireNoMoreBytes(const HeaderCount& count, std::uint64_t left, std::uint64_t record, bool exact = true);

/// One sentence for users about bytes behind the last record that is counted, for formats that allow other data there.
/// None where the bytes are too few for a record, or zeros: PCL writes these as padding.
/// @param first the first bytes behind that record: most_padding of them, or all
std::optional<std::string> remarkOnMoreBytes(const HeaderCount& count, std::uint64_t left, std::string_view first,
                                             std::uint64_t record);

inline constexpr std::size_t most_padding = std::size_t{1} << 16; ///< bytes that are searched for other values than 0

/// One sentence for users where the header counts another number than is there, for formats whose readers take all.
std::optional<std::string> remarkOnCount(const HeaderCount& count, std::uint64_t there);

} // namespace pcl_bsh::io
