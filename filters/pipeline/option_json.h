// SPDX-License-Identifier: BSD-3-Clause
// Options between JSON and their values.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/pipeline/stage_type.h>
#include <pcl_bsh/io/json/json_document.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_bsh::pipeline {

using io::Json;

/// A way to write a value in JSON.
struct Form {
  enum class Type : std::uint8_t { boolean, integer, number, text, name, numbers, limits, texts, rows };

  Type type;
  std::size_t count = 0; ///< of an array: how many numbers

  bool fits(const Json& json) const;
};

/// In which ways options of a kind may be written.
const std::vector<Form>& formsOf(Kind kind);

/// The values that are allowed: "a number above 0", "one of free, colliding".
std::string expectation(const Option& option);

/// Returns the value that an option's JSON stands for. A list of rows is returned empty: the parser reads each value of
/// a row by itself, so that errors have its place.
/// @throws std::invalid_argument `is X: give EXPECTATION`
PCL_BSH_EXPORT_INTERNAL Value valueOf(const Json& json, const Option& option);

PCL_BSH_EXPORT_INTERNAL Json jsonOf(const Value& value);

/// Rows become objects with the options that are given.
PCL_BSH_EXPORT_INTERNAL Json jsonOf(const Value& value, const Option& option);

/// The JSON of a command line's text: texts need no quotes, lists no brackets.
PCL_BSH_EXPORT_INTERNAL Json jsonOfText(const std::string& text, const Option& option);

} // namespace pcl_bsh::pipeline
