// SPDX-License-Identifier: BSD-3-Clause
// Whether a disk has room, asked before the work that fills it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace pcl_bsh::files {

/// The space that output will need.
struct WantedSpace {
  std::filesystem::path place; ///< a file or folder, which need not be there yet
  std::uint64_t bytes = 0;     ///< beside those in use now: a file that is replaced keeps its own until the end
};

/// Refuses outputs that do not fit on their disks. Several outputs on one disk must fit together. File systems that
/// report no size, as some of networks, refuse nothing.
/// @throws FileError that says how much is needed, and how much is free
void requireSpace(const std::vector<WantedSpace>& wanted);

/// The space of a folder's files on the disk, in bytes, with the folders in it; 0 where the folder does not exist.
std::uint64_t spaceTaken(const std::filesystem::path& folder);

} // namespace pcl_bsh::files
