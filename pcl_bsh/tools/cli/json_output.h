// SPDX-License-Identifier: BSD-3-Clause
// Reports for programs: in a file, or on standard output, where --json asks for it.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace pcl_bsh::cli {

/// Indented; bytes that are no UTF-8, as file names may hold, are replaced.
void writeJson(std::ostream& out, const nlohmann::ordered_json& report);

/// In a file, or on standard output as `-`. @throws files::FileError
void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& report);

/// What `check` returns. Where it throws, and `json` is set, standard output gets `failure` with the text as `error`.
template <class Check>
auto checkTold(bool json, nlohmann::ordered_json failure, const Check& check)
{
  try {
    return check();
  }
  catch (const std::runtime_error& error) {
    failure["error"] = error.what();
    if (json) writeJson(std::cout, failure);
    throw;
  }
}

} // namespace pcl_bsh::cli
