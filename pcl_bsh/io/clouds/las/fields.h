// SPDX-License-Identifier: BSD-3-Clause
// The fields of a LAS point: where each lies in a record of a file, and what it is called in a cloud.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// Bytes of a point of a format (0 to 10), without extra bytes.
std::size_t lasRecordBytes(std::uint8_t format);

bool hasLasWaves(std::uint8_t format);
bool hasLasColours(std::uint8_t format);

/// How a field's value follows from the one that is stored: stored x scale + offset.
struct LasScaling {
  double scale = 1;
  double offset = 0;
  std::optional<std::uint64_t> no_data; ///< the bits of the stored value, widened to 8 bytes, that stands for NaN
};

struct LasField {
  enum class Kind : std::uint8_t {
    plain,  ///< the stored value itself
    bits,   ///< some bits of a byte
    scaled, ///< by LasScaling
    colour, ///< PCL's packed rgb, from 16-bit red, green, blue, which are stored
  };

  std::string name;
  std::uint8_t datatype = 0; ///< of the cloud's field
  std::uint32_t count = 1;   ///< of the cloud's field
  Kind kind = Kind::plain;
  std::size_t at = 0;      ///< in the record
  std::uint8_t stored = 0; ///< datatype in the record
  std::uint8_t shift = 0;  ///< of bits
  std::uint8_t bits = 8;   ///< how many
  std::array<LasScaling, 3> scaling{};
  std::string descriptor{}; ///< of extra bytes, 192 bytes as in the file; empty for fields of the format
};

/// The fields of a point format, coordinates first. Types and names:
///
/// x y z                             float64, stored x scale + offset, each rounded to nearest
/// intensity point_source_id         uint16
/// return_number number_of_returns classification scanner_channel (6 to 10) user_data    uint8
/// synthetic key_point withheld overlap (6 to 10) scan_direction edge_of_flight_line     uint8, 0 or 1
/// scan_angle                        float32, degrees
/// gps_time                          float64
/// red green blue nir                uint16; beside them rgb, packed for PCL
/// wave_descriptor wave_offset wave_size wave_location wave_dx wave_dy wave_dz   uint8, uint64, uint32, float32
std::vector<LasField> lasFields(std::uint8_t format, const std::array<double, 3>& scale,
                                const std::array<double, 3>& offset);

/// Appends the extra bytes of a record. Bytes that `descriptors` (192 bytes each) describe become fields `extra_NAME`,
/// or `extra_NAME_2` ... where a name is taken; blanks and letters outside ASCII become '_'. The rest becomes a field
/// `extra_bytes` of bytes. A field with a scale, an offset or a value that stands for no data is float64, others have
/// their own type. Descriptors of more bytes than there are count for nothing (section 2.6.5 of the specification).
/// @throws FormatError when a scale or an offset is no number, or a scale is 0
void addExtraBytes(std::vector<LasField>& fields, std::string_view descriptors, std::size_t first_byte,
                   std::size_t record_length);

/// The description of new extra bytes: one value of a point, in its own type.
/// @param name, description of at most 32 bytes
std::string newDescriptor(const std::string& name, std::uint8_t datatype, const std::string& description);

/// The cloud's fields, without points. @return where in a record of the cloud each field goes
std::vector<std::uint32_t> layOutLas(const std::vector<LasField>& fields, pcl::PCLPointCloud2& cloud);

/// Reads a field of `points` records, which lie `record_length` apart, into a cloud's records, which lie `step` apart.
/// @param colour_shift of Kind::colour: how far a 16-bit channel is shifted to be a byte
void decodeLas(const LasField& field, const char* records, std::size_t record_length, std::size_t points,
               std::uint8_t* out, std::size_t step, unsigned colour_shift);

/// The way back, from a cloud's field of any type. Bytes of the records are zero before.
/// @return whether each value can be read back as it was; coordinates: whether each has a place
bool encodeLas(const LasField& field, const std::uint8_t* in, std::uint8_t datatype, std::size_t step,
               std::size_t points, char* records, std::size_t record_length);

/// Encodes a packed rgb or rgba as red, green and blue.
void encodeLasColour(const std::uint8_t* in, std::size_t step, std::size_t points, std::size_t red_at, char* records,
                     std::size_t record_length);

} // namespace pcl_bsh::io
