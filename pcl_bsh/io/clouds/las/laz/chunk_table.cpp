// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/laz/chunk_table.h>
#include <pcl_bsh/io/clouds/las/laz/integer_decompressor.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace pcl_bsh::io::laz {

namespace {

constexpr std::size_t place_bytes = 8, table_head = 8;
constexpr auto remedy_for_cut = "write or copy the file again, to its end";

/// Where the table is: told before the chunks, or, by a writer that could not go back there, in the last eight bytes.
/// None where it could not go back, and did not write them either.
/// @param end of the file; becomes eight less where the last eight bytes tell the place
std::optional<std::uint64_t> placeOfTable(ByteSource& file, const LasBlock& block, std::uint64_t& end)
{
  const std::uint64_t first_chunk = block.points_at + place_bytes;
  if (file.size() < first_chunk) throw FormatError("is truncated: it ends before its points");
  const auto told = [&](std::uint64_t at) { return lasNumber<std::uint64_t>(file.text(at, place_bytes), 0); };
  const auto inside = [&](std::uint64_t at) { return at >= first_chunk && at <= end && end - at >= table_head; };
  const std::uint64_t before = told(block.points_at);
  if (inside(before)) return before;
  end -= place_bytes;
  if (const std::uint64_t at = told(end); inside(at)) return at;
  end += place_bytes;
  if (before == std::numeric_limits<std::uint64_t>::max()) return std::nullopt;
  throw FormatError("is truncated: it has no table of its chunks", remedy_for_cut);
}

std::string nameOf(std::size_t chunk, std::size_t chunks)
{
  return "chunk " + std::to_string(chunk + 1) + " of " + std::to_string(chunks);
}

/// Requires that the points of a chunk fit its bytes.
void requireGrowth(const Chunk& chunk, const std::string& name, std::size_t record_length)
{
  if (chunk.points <= chunk.bytes * most_laz_growth / record_length) return;
  throw FormatError("its " + name + " should have " + std::to_string(chunk.points) + " points in " +
                    std::to_string(chunk.bytes) + " bytes");
}

/// The only chunk of a file of compressor 1, or without a table: to the end of the file, or to the records behind it.
ChunkTable oneChunk(ByteSource& file, const LasBlock& block, std::uint64_t at)
{
  ChunkTable table{{}, file.size(), 0};
  std::uint64_t end = file.size();
  if (block.extended_records > 0 && block.extended_at >= at) end = std::min(end, block.extended_at);
  table.chunks.push_back({0, block.points, at, end - at});
  requireGrowth(table.chunks.back(), "only chunk", block.record_length);
  return table;
}

} // namespace

ChunkTable readChunkTable(ByteSource& file, const LasBlock& block, const Scheme& scheme)
{
  if (!scheme.in_chunks) return oneChunk(file, block, block.points_at);
  ChunkTable table{{}, file.size(), 0};
  if (block.points == 0) return table;
  const std::optional<std::uint64_t> place = placeOfTable(file, block, table.end);
  if (!place && scheme.chunk_points == 0) {
    throw FormatError("has chunks of different sizes, and no table of them: it was not written to its end",
                      remedy_for_cut);
  }
  if (!place) return oneChunk(file, block, block.points_at + place_bytes);
  const std::uint64_t table_at = *place;
  const std::string head = file.text(table_at, table_head);
  const auto version = lasNumber<std::uint32_t>(head, 0), count = lasNumber<std::uint32_t>(head, 4);
  if (version != 0) throw FormatError("has a table of chunks of version " + std::to_string(version));
  Chunk chunk = {0, 0, block.points_at + place_bytes, 0};
  const std::uint64_t room = table_at - chunk.at;
  if (count > room / block.record_length) { // the first record of each is not compressed
    throw FormatError("its table of chunks has " + std::to_string(count) + " of them, for which " +
                      std::to_string(room) + " bytes are there");
  }
  // No count takes more than 16 bytes.
  const std::uint64_t most_bytes = std::min(table.end - table_at - table_head, 2 * 16 * std::uint64_t{count} + 16);
  const std::string bytes = file.text(table_at + table_head, static_cast<std::size_t>(most_bytes));
  ArithmeticDecoder in(bytes);
  IntegerDecompressor counts(32, 2);
  std::int32_t points = 0, size = 0;
  std::uint32_t i = 0;
  std::uint64_t told = 0; // points, by the table
  for (; i < count && chunk.first < block.points; ++i) {
    if (scheme.chunk_points == 0) points = counts.read(in, points, 0);
    size = counts.read(in, size, 1);
    chunk.points = scheme.chunk_points != 0 ? scheme.chunk_points : static_cast<std::uint32_t>(points);
    told += chunk.points;
    chunk.points = std::min(chunk.points, block.points - chunk.first);
    chunk.bytes = static_cast<std::uint32_t>(size);
    if (chunk.bytes > table_at - chunk.at || (chunk.points > 0 && chunk.bytes < block.record_length)) {
      throw FormatError("its " + nameOf(i, count) + " should take " + std::to_string(chunk.bytes) +
                        " bytes from byte " + std::to_string(chunk.at) + " on, where " +
                        std::to_string(table_at - chunk.at) + " are");
    }
    requireGrowth(chunk, nameOf(i, count), block.record_length);
    if (chunk.points > 0) table.chunks.push_back(chunk);
    chunk.first += chunk.points;
    chunk.at += chunk.bytes;
  }
  // If chunks have one size, all except the last are full.
  if (scheme.chunk_points != 0) told = i < count ? (count - 1) * std::uint64_t{scheme.chunk_points} + 1 : block.points;
  for (; i < count && scheme.chunk_points == 0; ++i) {
    points = counts.read(in, points, 0);
    size = counts.read(in, size, 1);
    told += static_cast<std::uint32_t>(points);
  }
  table.more = told - std::min(told, block.points);
  if (chunk.first < block.points) {
    throw FormatError("is truncated: its header promises " + std::to_string(block.points) +
                      " points, its chunks have " + std::to_string(chunk.first));
  }
  return table;
}

} // namespace pcl_bsh::io::laz
