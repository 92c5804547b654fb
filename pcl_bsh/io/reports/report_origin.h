// SPDX-License-Identifier: BSD-3-Clause
// What every report says of itself: which program made it, and when; and as what it is written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// "pcl_bsh 0.1.0".
std::string reportProgram();

/// Today in UTC, as 2026-11-23. The environment's SOURCE_DATE_EPOCH, seconds since 1970, takes the clock's place: so a
/// report can be made again byte for byte.
/// @throws std::runtime_error naming the variable when it is no such number
std::string reportDate();

/// The file's extension. @throws files::FileError when it is none of these. As reportDate(), before anything is done
std::string formatOf(const std::filesystem::path& file, const std::vector<std::string>& known);

} // namespace pcl_bsh::io
