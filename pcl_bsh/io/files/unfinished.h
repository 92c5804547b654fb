// SPDX-License-Identifier: BSD-3-Clause
// The files and folders that a program would leave behind if it ended now.
#pragma once

#include <filesystem>
#include <mutex>

namespace pcl_bsh::files {

/// Removes all listed files and empty folders: the temporary file of every FileReplacement that is under way, which
/// then fails, every NewFile that is not kept, and folders of every OutputFolder. While the returned lock lives, no
/// other replacement begins or ends. For programs that are told to stop.
std::unique_lock<std::mutex> discardUnfinished();

/// To be held while a listed file or folder is made or removed: the disk and the list change together.
std::unique_lock<std::mutex> lockUnfinished();

/// Under that lock: lists a file or folder, or takes it off the list.
void addUnfinished(const std::filesystem::path& path);
void dropUnfinished(const std::filesystem::path& path);

} // namespace pcl_bsh::files
