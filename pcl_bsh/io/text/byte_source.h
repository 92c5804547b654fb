// SPDX-License-Identifier: BSD-3-Clause
// Bytes of a file at any place, for formats that are not read from front to back, or are too large to be held.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

class ByteSource {
public:
  virtual ~ByteSource() = default;

  virtual std::uint64_t size() const = 0;

  /// Copies `count` bytes from `at` on, all of which are there.
  virtual void read(std::uint64_t at, char* to, std::size_t count) = 0;

  /// Returns `count` bytes from `at` on. @pre all of them lie within size()
  std::string text(std::uint64_t at, std::size_t count)
  {
    std::string bytes(count, '\0');
    read(at, bytes.data(), count);
    return bytes;
  }
};

/// Bytes that are in memory already, and stay there.
class HeldBytes : public ByteSource {
public:
  explicit HeldBytes(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t at, char* to, std::size_t count) override { bytes_.copy(to, count, at); }

private:
  std::string_view bytes_;
};

/// Opens a regular file. Its bytes are not held in memory.
/// @throws files::FileError when it cannot be read, is empty, or is no regular file; read() does when the disk fails or
///   the file has become shorter meanwhile
std::unique_ptr<ByteSource> openBytes(const std::filesystem::path& path);

} // namespace pcl_bsh::io
