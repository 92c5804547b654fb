// SPDX-License-Identifier: BSD-3-Clause
// A whole file as bytes, or how it begins.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

namespace pcl_bsh::io {

/// Read, not mapped: a mapped file that someone cuts short takes the process with it.
class FileBytes {
public:
  /// @param path a file, a pipe, or `-` for standard input
  /// @param most the number of bytes that are read at most
  /// @throws files::FileError when it cannot be read or there is nothing in it
  explicit FileBytes(const std::filesystem::path& path, std::size_t most = std::numeric_limits<std::size_t>::max());

  std::string_view view() const noexcept { return {bytes_.get(), size_}; }

  /// Whether reading came to the end of the file: the bytes are all that it has.
  bool isWhole() const noexcept { return is_whole_; }

private:
  struct Free {
    void operator()(char* bytes) const noexcept { std::free(bytes); }
  };

  void read(int descriptor, std::size_t expected, std::size_t most);
  void reserve(std::size_t size);

  std::unique_ptr<char, Free> bytes_;
  std::size_t size_ = 0, reserved_ = 0;
  bool is_whole_ = false;
};

/// Whether a name stands for standard input or a pipe: it can be read once, and its extension may say nothing.
bool isPipe(const std::filesystem::path& path);

} // namespace pcl_bsh::io
