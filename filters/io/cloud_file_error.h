// SPDX-License-Identifier: BSD-3-Clause
// How reading and writing fails.
#pragma once

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace pcl_bsh::io {

/// A file that cannot be read or written. what() is one line: `path: what is wrong: what to do`.
class CloudFileError : public std::runtime_error {
public:
  CloudFileError(const std::filesystem::path& path, const std::string& wrong, const std::string& remedy)
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

inline constexpr auto remedy_for_damage = "export or copy the file again";

/// What is wrong with a file's content, told by code that does not know the file's name.
class FormatError : public std::runtime_error {
public:
  explicit FormatError(const std::string& wrong, std::string remedy = remedy_for_damage)
  : std::runtime_error(wrong),
    remedy_(std::move(remedy))
  {
  }

  const std::string& remedy() const noexcept { return remedy_; }

private:
  std::string remedy_;
};

} // namespace pcl_bsh::io
