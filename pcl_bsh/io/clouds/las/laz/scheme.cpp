// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/clouds/las/laz/scheme.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <array>
#include <limits>

namespace pcl_bsh::io::laz {

namespace {

enum Compressor : std::uint16_t { pointwise = 1, pointwise_in_chunks, layered_in_chunks };

struct KnownItem {
  std::uint16_t type;
  const char* name;
  std::size_t size; ///< 0: any
  unsigned first_version, last_version;
  NewPointwise* pointwise;
  NewLayered* layered;
};

constexpr std::uint16_t point14_type = 10;

constexpr std::array<KnownItem, 10> known_items = {{
    {0, "BYTE", 0, 1, 2, newBytes, nullptr},
    {6, "POINT10", 20, 1, 2, newPoint10, nullptr},
    {7, "GPSTIME11", 8, 1, 2, newGpsTime11, nullptr},
    {8, "RGB12", 6, 1, 2, newRgb12, nullptr},
    {9, "WAVEPACKET13", 29, 1, 1, newWavePacket13, nullptr},
    {point14_type, "POINT14", 30, 3, 4, nullptr, newPoint14},
    {11, "RGB14", 6, 3, 4, nullptr, newRgb14},
    {12, "RGBNIR14", 8, 3, 4, nullptr, newRgbNir14},
    {13, "WAVEPACKET14", 29, 3, 4, nullptr, newWavePacket14},
    {14, "BYTE14", 0, 3, 4, nullptr, newBytes14},
}};

constexpr auto save_anew = "save it as .las";

/// @throws FormatError when the item is not read
Scheme::Part partOf(std::uint16_t type, std::size_t size, unsigned version, bool layered)
{
  const auto known =
      std::find_if(known_items.begin(), known_items.end(), [&](const KnownItem& item) { return item.type == type; });
  if (known == known_items.end()) {
    throw FormatError("its points have an item of type " + std::to_string(type) + ", which is not read", save_anew);
  }
  const std::string named = std::string("its points have the item ") + known->name;
  if (version < known->first_version || version > known->last_version) {
    throw FormatError(named + " in version " + std::to_string(version) + "; read is " +
                          std::to_string(known->first_version) + " to " + std::to_string(known->last_version),
                      save_anew);
  }
  if (size == 0 || (known->size != 0 && size != known->size)) {
    throw FormatError(named + " of " + std::to_string(size) + " bytes");
  }
  if ((known->layered != nullptr) != layered) {
    throw FormatError(named + (layered ? " among layers" : " outside layers"), save_anew);
  }
  return {known->pointwise, known->layered, size, version};
}

} // namespace

Scheme parseScheme(std::string_view record, std::size_t record_length)
{
  constexpr std::size_t head = 34, item_bytes = 6;
  const std::size_t count = record.size() < head ? 0 : lasNumber<std::uint16_t>(record, 32);
  if (count == 0 || (record.size() - head) / item_bytes < count) {
    throw FormatError("has a record of its compression that is not complete");
  }
  const auto compressor = lasNumber<std::uint16_t>(record, 0), coder = lasNumber<std::uint16_t>(record, 2);
  if (compressor < pointwise || compressor > layered_in_chunks || coder != 0) {
    throw FormatError("is compressed by method " + std::to_string(compressor) + " and coder " + std::to_string(coder) +
                          " of LASzip; read are methods 1 to 3 and coder 0",
                      save_anew);
  }
  Scheme scheme;
  scheme.in_chunks = compressor != pointwise;
  scheme.layered = compressor == layered_in_chunks;
  const auto chunk_points = lasNumber<std::uint32_t>(record, 12);
  const bool alike = scheme.in_chunks && chunk_points != std::numeric_limits<std::uint32_t>::max();
  scheme.chunk_points = alike ? chunk_points : 0;
  std::size_t length = 0;
  for (std::size_t at = head; scheme.parts.size() < count; at += item_bytes) {
    const auto type = lasNumber<std::uint16_t>(record, at);
    const Scheme::Part part = partOf(type, lasNumber<std::uint16_t>(record, at + 2),
                                     lasNumber<std::uint16_t>(record, at + 4), scheme.layered);
    if (scheme.layered && scheme.parts.empty() != (type == point14_type)) {
      throw FormatError("its points do not begin with the one item POINT14");
    }
    length += part.size;
    scheme.parts.push_back(part);
  }
  if (length != record_length) {
    throw FormatError("its points take " + std::to_string(record_length) + " bytes each, of which " +
                      std::to_string(length) + " are compressed");
  }
  return scheme;
}

} // namespace pcl_bsh::io::laz
