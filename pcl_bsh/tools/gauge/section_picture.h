// SPDX-License-Identifier: BSD-3-Clause
// Drawings of sections as pictures: SVG drawn as PNG by librsvg, where that was there when this was built.
#pragma once

#include <filesystem>
#include <string>

namespace pcl_bsh::cli {

/// @throws UsageError naming the package that this build lacks
void requirePictures();

/// Writes a PNG in which a unit of the drawing is three pixels wide. @throws files::FileError
void writePicture(const std::filesystem::path& path, const std::string& svg);

} // namespace pcl_bsh::cli
