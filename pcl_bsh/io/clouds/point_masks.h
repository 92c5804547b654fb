// SPDX-License-Identifier: BSD-3-Clause
// Masks of points that do not count, from files.
#pragma once

#include <pcl_bsh/question/ignored_points.h>

#include <filesystem>
#include <vector>

namespace pcl_bsh::io {

/// Reads the mask of each term that names one: a 0 or a 1 a line, in the order of the points. Empty lines and text
/// after a # are ignored.
/// @throws files::FileError for a file that cannot be read, and naming the line that has something else
void readMasks(IgnoredPoints& ignored);

/// The files of these masks.
std::vector<std::filesystem::path> maskFilesOf(const IgnoredPoints& ignored);

} // namespace pcl_bsh::io
