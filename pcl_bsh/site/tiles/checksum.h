// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <libdeflate.h>

#include <cstddef>
#include <cstdint>

namespace pcl_bsh::site {

/// CRC-32 of bytes that come one after the other.
class Checksum {
public:
  void add(const void* bytes, std::size_t count) noexcept { crc_ = libdeflate_crc32(crc_, bytes, count); }
  std::uint32_t value() const noexcept { return crc_; }

private:
  std::uint32_t crc_ = 0;
};

/// Returns the checksum of all bytes of a string, or of a cloud's records.
template <typename Bytes>
std::uint32_t crcOf(const Bytes& bytes)
{
  Checksum checksum;
  checksum.add(bytes.data(), bytes.size());
  return checksum.value();
}

} // namespace pcl_bsh::site
