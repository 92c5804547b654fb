// SPDX-License-Identifier: BSD-3-Clause
// One of many files that are of use only together, as the tiles of a site.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace pcl_bsh::files {

/// A file that grows piece by piece and is removed in the end, unless it is to be kept. Between pieces it is closed, so
/// that there may be more of them than a process may have open.
class NewFile {
public:
  /// @throws FileError when a file of that name is there already, or cannot be made
  explicit NewFile(const std::filesystem::path& path);

  /// Goes on with a file that an earlier run has kept: what is behind its first `size` bytes is cut off.
  /// @throws FileError when it has not so many, or cannot be written
  NewFile(const std::filesystem::path& path, std::uint64_t size);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

  /// Writes bytes behind the last ones. @throws FileError
  void append(std::string_view bytes);

  /// Replaces the first bytes, all of which are there. @throws FileError
  void replaceHead(std::string_view bytes);

  /// Keeps the file from now on; a second call has no effect. @pre lockUnfinished() is held, as it is while
  /// FileReplacement::commit() calls its function: so all files are kept at one moment
  void keep();

private:
  std::filesystem::path path_;
  std::uint64_t size_ = 0;
  bool kept_ = false;
};

/// Flushes all files of the file system that holds a folder to the disk. For thousands of files it takes a tenth of the
/// time that one by one would take. @throws FileError
void syncDisk(const std::filesystem::path& folder);

} // namespace pcl_bsh::files
