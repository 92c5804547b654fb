// SPDX-License-Identifier: BSD-3-Clause
// The error of reading and writing files.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/io/files/one_line.h>

#include <filesystem>
#include <stdexcept>
#include <string>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::files {

/// A file that cannot be read or written. what() is one line: `path: what is wrong: what to do`.
class FileError : public std::runtime_error {
public:
  FileError(const std::filesystem::path& path, const std::string& wrong, const std::string& remedy)
  : std::runtime_error(oneLine(path.string() + ": " + wrong + ": " + remedy))
  {
  }
};

} // namespace pcl_bsh::files
PCL_BSH_EXPORT_END
