// SPDX-License-Identifier: BSD-3-Clause
// A JSON text with comments, refused where a lenient parser would guess, and values as messages quote them.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

using Json = nlohmann::ordered_json; // keys stay in the order they were written

/// // and /* */ comments are allowed.
/// @throws FormatError for what is no JSON, with line and column where it breaks off; for a key that an object says
///   twice, or nesting of more than a hundred levels
Json parseJson(std::string_view text);

/// A value as an error message quotes it: on one line, shortened.
std::string shown(const Json& value);

/// The text with U+FFFD in place of bytes that are not UTF-8.
std::string validUtf8(std::string_view text);

/// A finite number, or null: NaN and infinity have no place in JSON. A text, or null where it is empty.
Json orNull(double number);
Json orNull(const std::string& text);

/// Indented; bytes that are no UTF-8, as file names may hold, are replaced.
std::string printed(const Json& json);

/// Writes to a file, or to standard output for `-`. @throws files::FileError
void writeJson(const std::filesystem::path& file, const Json& json);

} // namespace pcl_bsh::io
