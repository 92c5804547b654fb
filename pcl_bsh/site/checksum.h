// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/crc.hpp>

#include <cstdint>

namespace pcl_bsh::sites {

/// CRC-32 of all bytes of a string, or of a cloud's records.
template <typename Bytes>
std::uint32_t crcOf(const Bytes& bytes)
{
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

} // namespace pcl_bsh::sites
