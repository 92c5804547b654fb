// SPDX-License-Identifier: BSD-3-Clause
// How reading a format fails.
#pragma once

#include <pcl_bsh/io/files/file_error.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace pcl_bsh::io {

inline constexpr auto remedy_for_damage = "export or copy the file again";

/// The fault in a file's content, told by code that does not know the file's name.
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

/// Returns the result of `read`. @throws files::FileError naming the file for its FormatError
template <typename Read>
auto naming(const std::filesystem::path& path, const Read& read)
{
  try {
    return read();
  }
  catch (const FormatError& error) {
    throw files::FileError(path, error.what(), error.remedy());
  }
}

} // namespace pcl_bsh::io
