// SPDX-License-Identifier: BSD-3-Clause
// The binary section of a scan in an E57 file: packets, each with a piece of the bit stream of every value of a point.
// Streams need not be in step, so each is read by a cursor of its own; a few packets are held.
#pragma once

#include <pcl_bsh/io/clouds/e57/pages.h>
#include <pcl_bsh/io/clouds/stored_number.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace pcl_bsh::io {

class E57Streams {
public:
  /// @param section_at physical offset @param streams number of values in the prototype
  /// @throws FormatError for another section
  E57Streams(E57Pages& pages, std::uint64_t section_at, std::size_t streams);

  /// Calls take(i, bits) for the next values of a stream, i from 0, that have `width` bits, of 64 at most.
  /// @throws FormatError where the section ends before, or is damaged
  template <class Take>
  void read(std::size_t stream, unsigned width, std::size_t count, const Take& take)
  {
    if (width == 0) {
      for (std::size_t i = 0; i < count; ++i) take(i, std::uint64_t{0});
      return;
    }
    Cursor& cursor = cursors_[stream];
    for (std::size_t done = 0; done < count;) {
      const auto whole =
          static_cast<std::size_t>(std::min<std::uint64_t>((cursor.end - cursor.bit) / width, count - done));
      if (whole == 0) {
        take(done++, valueAcross(stream, width));
        continue;
      }
      const std::uint8_t* const bytes = packetAt(cursor.packet).bytes.data();
      for (std::size_t i = 0; i < whole; ++i) take(done + i, bitsAt(bytes, cursor.bit + i * width, width));
      cursor.bit += std::uint64_t{whole} * width;
      done += whole;
    }
  }

private:
  static constexpr std::uint64_t nowhere = ~std::uint64_t{0};

  /// A packet of data as it is in the file, which is the first at a place or behind it: other packets are skipped.
  struct Packet {
    std::uint64_t at = nowhere;      ///< logical; the place from which it was looked for
    std::uint64_t data_at = nowhere; ///< logical; where it is
    std::uint64_t next = 0;
    std::vector<std::uint32_t> starts; ///< of streams, in bytes, and the last one's end
    std::vector<std::uint8_t> bytes;   ///< with room behind, for bitsAt()
  };

  /// How far a stream is read.
  struct Cursor {
    std::uint64_t packet = 0, next = 0; ///< logical
    std::uint64_t bit = 0, end = 0;     ///< in the packet
  };

  static std::uint64_t bitsAt(const std::uint8_t* bytes, std::uint64_t bit, unsigned width) noexcept
  {
    bytes += bit / 8;
    const unsigned shift = bit % 8;
    std::uint64_t value = loaded<std::uint64_t>(bytes) >> shift;
    if (shift + width > 64) value |= std::uint64_t{bytes[8]} << (64 - shift);
    return width == 64 ? value : value & ((std::uint64_t{1} << width) - 1);
  }

  const Packet& packetAt(std::uint64_t at);
  void load(Packet& packet, std::uint64_t at);
  std::uint64_t valueAcross(std::size_t stream, unsigned width);

  E57Pages& pages_;
  std::uint64_t end_; ///< logical
  std::vector<Cursor> cursors_;
  std::array<Packet, 8> packets_;
  std::size_t oldest_ = 0;
};

} // namespace pcl_bsh::io
