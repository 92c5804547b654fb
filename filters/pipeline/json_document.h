// SPDX-License-Identifier: BSD-3-Clause
// A JSON text with comments, refused where a lenient parser would guess.
#pragma once

#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>
#include <string_view>

namespace pcl_bsh::pipeline {

using Json = nlohmann::ordered_json; // keys stay in the order they were written

/// The text is no JSON, says a key of an object twice, or nests deeper than any pipeline does.
class JsonError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// @throws JsonError, with line and column where the text breaks off
Json parseJson(std::string_view text);

/// A value as an error message quotes it: on one line, shortened.
std::string shown(const Json& value);

/// Indented; bytes that are no UTF-8, as file names may hold, are replaced.
std::string printed(const Json& json);

} // namespace pcl_bsh::pipeline
