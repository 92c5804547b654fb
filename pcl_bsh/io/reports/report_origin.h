// SPDX-License-Identifier: BSD-3-Clause
// The origin of a report, its program and its date, and the format of its file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// "pcl_bsh 0.1.0".
std::string reportProgram();

/// Returns today in UTC, as 2026-11-23. The environment's SOURCE_DATE_EPOCH, seconds since 1970, replaces the clock, so
/// that a report can be made again byte for byte.
/// @throws std::runtime_error naming the variable when it is no such number
std::string reportDate();

/// Returns the file's extension.
/// @throws files::FileError for an extension that is not known; as reportDate() does, so that a run fails before its
///   work
std::string formatOf(const std::filesystem::path& file, const std::vector<std::string>& known);

} // namespace pcl_bsh::io
