// SPDX-License-Identifier: BSD-3-Clause
// Output that appears complete or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <ostream>

namespace pcl_bsh::io {

/// Lets `write` fill a temporary file beside `path`, then renames it to `path`. When anything throws or the disk is
/// full, `path` is as it was and nothing is left behind. A link is followed; a device or pipe is written to directly.
/// @throws CloudFileError, and whatever `write` throws
void replaceFile(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// @throws CloudFileError when a file cannot be made at `path`, because of its folder or of what stands there
void requireWritable(const std::filesystem::path& path);

/// Removes the temporary files of every replaceFile() that is under way; those fail. While the lock that is returned
/// lives, no other is begun or ends. For programs that are told to stop.
std::unique_lock<std::mutex> discardUnfinishedFiles();

} // namespace pcl_bsh::io
