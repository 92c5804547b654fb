// SPDX-License-Identifier: BSD-3-Clause
// The part of a LAS file beside its points: LAS specification 1.4 R15 (ASPRS), and 1.0 to 1.3 before it.
#pragma once

#include <pcl_bsh/io/clouds/stored_number.h>
#include <pcl_bsh/io/clouds/systems/coordinate_system.h>
#include <pcl_bsh/io/text/byte_source.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The numbers of a public header block (section 2.4) that say where and how the points are stored.
struct LasBlock {
  std::uint8_t minor = 4; ///< the version is 1.minor
  std::uint16_t global_encoding = 0;
  std::uint16_t header_size = 0;
  std::uint32_t points_at = 0; ///< the first point's first byte
  std::uint32_t variable_records = 0;
  std::uint8_t format = 0; ///< of the points, 0 to 10
  bool compressed = false; ///< LAZ: what lies behind the header is where unpacked_laz.h says
  std::uint16_t record_length = 0;
  std::uint64_t points = 0;
  std::array<double, 3> scale{}, offset{};
  std::uint64_t waveforms_at = 0; ///< 0 where the version has none
  std::uint64_t extended_at = 0;
  std::uint32_t extended_records = 0;

  std::uint64_t endOfPoints() const { return points_at + points * record_length; }
};

/// Where the numbers stand.
namespace las_at {
inline constexpr std::size_t global_encoding = 6, major = 24, minor = 25, system = 26, software = 58, day = 90,
                             year = 92, header_size = 94, points_at = 96, variable_records = 100, format = 104,
                             record_length = 105, old_points = 107, old_returns = 111, scale = 131, offset = 155,
                             bounds = 179, waveforms = 227, extended = 235, extended_records = 243, points = 247,
                             returns = 255;
} // namespace las_at

inline constexpr std::size_t las_old_block_bytes = 227; ///< of versions 1.0 to 1.2
inline constexpr std::size_t las_block_bytes = 375;     ///< of version 1.4
inline constexpr std::uint8_t las_compressed = 0x80;    ///< in the point format's byte
inline constexpr std::size_t las_record_head = 54, las_extended_head = 60;

/// A number at a place of a text, in the byte order of LAS, which is this machine's.
template <typename T>
T lasNumber(std::string_view bytes, std::size_t at)
{
  return loaded<T>(bytes.data() + at);
}

template <typename T>
void setLasNumber(std::string& bytes, std::size_t at, T value)
{
  store(bytes.data() + at, value);
}

/// Reads the public header block and checks all of it that says where something is.
/// @throws FormatError when the points or the records behind them are not in the file, or scales are no numbers. In a
///   compressed file it looks neither for the points nor for the records behind them
LasBlock readLasBlock(ByteSource& file);

/// A variable length record with its head of 54 bytes.
struct LasRecord {
  std::string bytes;

  std::string_view user() const { return {bytes.data() + 2, strnlen(bytes.data() + 2, 16)}; }
  std::uint16_t id() const { return lasNumber<std::uint16_t>(bytes, 18); }
  std::string_view content() const { return std::string_view(bytes).substr(las_record_head); }
};

/// The records between the public header block and the points: as many as the block counts and as have room there. The
/// rest, such as the signature of LAS 1.0, is padding.
struct LasRecords {
  std::vector<LasRecord> records;
  std::string padding;
};
LasRecords lasRecordsOf(const std::string& before_points, const LasBlock& block);

/// An extended variable length record behind the points.
struct LasExtendedRecord {
  std::uint64_t at; ///< in the file
  std::uint64_t content_bytes;
  std::string user;
  std::uint16_t id;
};

/// @throws FormatError when one does not lie in the file
std::vector<LasExtendedRecord> lasExtendedRecords(ByteSource& file, const LasBlock& block);

/// All bytes of a LAS file but its points, and what they say. A writer changes in them only what its points ask for, so
/// that what this project does not know is kept as well.
struct LasHeader {
  LasBlock block = {};
  std::string before_points = {}; ///< the public header block, variable length records, padding; or none
  std::string behind_points = {}; ///< extended variable length records, waveforms
  std::string descriptors = {};   ///< of extra bytes
  std::optional<std::uint64_t> described_behind = {}; ///< where in behind_points the extended record of these is
  CoordinateSystem system = {};                       ///< of points from another file: all that is known then
};

inline constexpr std::string_view las_specification = "LASF_Spec";
inline constexpr std::string_view las_projection = "LASF_Projection";
inline constexpr std::uint16_t las_extra_bytes_id = 4, las_superseded_id = 7, las_wkt_id = 2112;
inline constexpr std::size_t las_descriptor_bytes = 192; ///< of one of the extra bytes' descriptions

} // namespace pcl_bsh::io
