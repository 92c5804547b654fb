// SPDX-License-Identifier: BSD-3-Clause
// An E57 file (ASTM E2807) as the bytes that it holds: pages, each with a checksum at its end, that is verified here.
#pragma once

#include <pcl_bsh/io/text/byte_source.h>

#include <cstdint>
#include <memory>
#include <string>

namespace pcl_bsh::io {

/// Offsets in the file are physical: they count checksums, too. Offsets of read() are logical: they do not.
class E57Pages {
public:
  /// @throws FormatError for what the file's header can tell
  explicit E57Pages(std::unique_ptr<ByteSource> file);

  /// Logical bytes of all pages.
  std::uint64_t size() const noexcept { return file_bytes_ / page_ * payload(); }

  /// @throws FormatError for an offset behind the file, or within a checksum
  std::uint64_t logical(std::uint64_t physical) const;

  /// Copies logical bytes. @throws FormatError where a page has another checksum, or the file ends before
  void read(std::uint64_t at, std::uint8_t* to, std::size_t count);

  /// The section of XML. @throws FormatError as read() does, and for one that is too long to be sound
  std::string xml();

private:
  std::uint64_t payload() const noexcept { return page_ - checksum_bytes; }
  void fillWindow(std::uint64_t page);

  static constexpr std::uint64_t checksum_bytes = 4;
  std::unique_ptr<ByteSource> file_;
  std::uint64_t file_bytes_ = 0, page_ = 1024, xml_at_ = 0, xml_bytes_ = 0;
  std::string window_;          ///< the verified bytes of some pages, without their checksums
  std::uint64_t window_at_ = 0; ///< its first byte's logical place
};

/// CRC-32C, of Castagnoli's polynomial.
std::uint32_t crc32c(const std::uint8_t* bytes, std::size_t count) noexcept;

} // namespace pcl_bsh::io
