// SPDX-License-Identifier: BSD-3-Clause
// Which names are one file.
#pragma once

#include <filesystem>
#include <string>

namespace pcl_bsh::files {

/// The name that stands for standard input where a file is read, and for standard output where one is written. A file
/// of this name is `./-`.
inline const std::filesystem::path standard_stream = "-";

enum class Use { read, written };

/// The folder that holds `path`.
std::filesystem::path folderOf(const std::filesystem::path& path);

/// The file that is there or would be made: links are followed, also where they lead to no file yet.
/// @throws FileError for a link that leads back to itself
std::filesystem::path destinationOf(const std::filesystem::path& path);

/// Identifies a file, whatever its name. A name for which there is no file yet is identified by the place where the
/// file would be. Names which differ only in the case of ASCII letters are one such place, since many disks hold them
/// to be one.
class FileIdentity {
public:
  /// @param use says which stream `standard_stream` is
  FileIdentity(const std::filesystem::path& path, Use use);

  bool operator==(const FileIdentity& other) const
  {
    return device_ == other.device_ && inode_ == other.inode_ && place_ == other.place_;
  }

  /// A pipe or socket: what is read from it once is gone.
  bool isStream() const noexcept { return is_stream_; }

  /// As /dev/null: takes whatever is written, and holds no file.
  bool isDevice() const noexcept { return is_device_; }

private:
  unsigned long long device_ = 0, inode_ = 0; ///< of the file, or of the folder where it would be
  std::string place_;                         ///< in that folder; without a folder, all of the path
  bool is_stream_ = false, is_device_ = false;
};

} // namespace pcl_bsh::files
