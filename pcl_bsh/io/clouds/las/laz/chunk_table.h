// SPDX-License-Identifier: BSD-3-Clause
// Where the chunks of a LAZ file are, and which points each has.
#pragma once

#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/clouds/las/laz/scheme.h>
#include <pcl_bsh/io/text/byte_source.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh::io::laz {

struct Chunk {
  std::uint64_t first; ///< its first point
  std::uint64_t points;
  std::uint64_t at; ///< in the file
  std::uint64_t bytes;
};

/// Chunks of one size need no table: where it is missing, one entry stands for all chunks together.
struct ChunkTable {
  std::vector<Chunk> chunks; ///< those that have points, which together have all of the header's
  std::uint64_t end;         ///< of the file, less the last eight bytes where they have the place of the table
  std::uint64_t more = 0;    ///< points that chunks have at least, and the header does not count
};

/// The most bytes of points that are taken from one compressed byte. Points of a scan take some ten, points that are
/// all the same some thousands.
inline constexpr std::uint64_t most_laz_growth = std::uint64_t{1} << 14;

/// Takes no more memory than the chunks take in the file.
/// @param block of the compressed file
/// @throws FormatError when the table is cut off, is missing though chunks differ, or says what the file has no room
/// for
ChunkTable readChunkTable(ByteSource& file, const LasBlock& block, const Scheme& scheme);

} // namespace pcl_bsh::io::laz
