// SPDX-License-Identifier: BSD-3-Clause
// Names whose case does not matter: extensions of files, fields, tags.
#pragma once

#include <filesystem>
#include <string>

namespace pcl_bsh::io {

/// The text with a-z for A-Z.
std::string inSmallLetters(std::string text);

/// The extension in small letters with its dot, which tells the format: ".ply" of "Scan.PLY"; empty without one.
std::string extensionOf(const std::filesystem::path& file);

} // namespace pcl_bsh::io
