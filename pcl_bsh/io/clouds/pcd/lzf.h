// SPDX-License-Identifier: BSD-3-Clause
// LZF, the coding of PCD's compressed points, as PCL reads and writes it. PCL's own is in pcl_io, which loads 47
// libraries for windows and cameras: 20 MB, and half of the time that a program takes to start.
//
// A stream is literals and copies of what was decoded. A control byte below 32 says how many literals follow, less one.
// Any other holds a length, less two, in its upper three bits; its lower five and the next byte are the distance back,
// less one, 8192 at most. A length of seven there is longer by another byte, which stands before the distance's.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

/// Compresses fewer than 2^32 bytes. The stream is at most a 32nd longer than the bytes, rounded up, and depends on
/// them alone.
std::string lzfOf(std::span<const std::uint8_t> bytes);

/// Decodes a stream into `bytes`. @returns whether it is sound and fills them exactly
bool readLzf(std::string_view stream, std::span<std::uint8_t> bytes);

} // namespace pcl_bsh::io
