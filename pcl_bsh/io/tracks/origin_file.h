// SPDX-License-Identifier: BSD-3-Clause
// The path of a moving scanner, with times, from a file.
#pragma once

#include <pcl_bsh/track/origin_path.h>

#include <filesystem>

namespace pcl_bsh::io {

/// Reads a place in each line, in columns that the first line names: time, x y z (also E N H). Times rise.
/// @throws files::FileError naming the file, the line, the value, and what to do
OriginPath readOriginPath(const std::filesystem::path& path);

} // namespace pcl_bsh::io
