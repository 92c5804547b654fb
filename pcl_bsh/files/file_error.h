// SPDX-License-Identifier: BSD-3-Clause
// The error of reading and writing files.
#pragma once

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace pcl_bsh::files {

/// A file that cannot be read or written. what() is one line: `path: what is wrong: what to do`.
class FileError : public std::runtime_error {
public:
  FileError(const std::filesystem::path& path, const std::string& wrong, const std::string& remedy)
  : std::runtime_error(printable(path.string() + ": " + wrong + ": " + remedy))
  {
  }

private:
  /// Bytes of a damaged file may be quoted; they must not steer the terminal nor break the line.
  static std::string printable(std::string line)
  {
    const auto steers = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    std::replace_if(line.begin(), line.end(), steers, '?');
    return line;
  }
};

} // namespace pcl_bsh::files
