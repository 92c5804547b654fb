// SPDX-License-Identifier: BSD-3-Clause
// What a program would leave behind if it ended now.
#pragma once

#include <filesystem>
#include <mutex>

namespace pcl_bsh::files {

/// Removes the temporary file of every FileReplacement that is under way, and the folders of every OutputFolder that
/// are empty then; those fail. While the lock that is returned lives, no other is begun or ends. For programs that are
/// told to stop.
std::unique_lock<std::mutex> discardUnfinished();

/// Held by whoever makes or removes something that is listed: what is on disk and what is listed change together.
std::unique_lock<std::mutex> lockUnfinished();

/// Under that lock: lists a file or folder, or takes it off the list.
void addUnfinished(const std::filesystem::path& path);
void dropUnfinished(const std::filesystem::path& path);

} // namespace pcl_bsh::files
