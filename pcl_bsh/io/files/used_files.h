// SPDX-License-Identifier: BSD-3-Clause
// No file of a job may be written over another file of the same job.
#pragma once

#include <pcl_bsh/io/files/file_identity.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::files {

/// A file that a job reads or writes.
struct UsedFile {
  std::string name; ///< of the option or stage that names it
  std::filesystem::path path;
  Use use = Use::read;
  std::string replaces = {}; ///< when written: the name of the one input which the user wants to have replaced
};

/// Two names of one file.
struct FileClash {
  std::size_t file;  ///< the one to choose another name for: written, or a pipe
  std::size_t other; ///< never equal to `file`
  std::string wrong; ///< `is the file of OTHER, which is read: choose another name`
};

/// Finds two names of one file that are in each other's way: one is written and the other read or written; or both are
/// read, and the file is a pipe. Devices such as /dev/null are never in the way.
/// @return of several, the first by `file`, then by `other`
/// @throws FileError for a link that leads back to itself
std::optional<FileClash> findClash(const std::vector<UsedFile>& files);

} // namespace pcl_bsh::files
