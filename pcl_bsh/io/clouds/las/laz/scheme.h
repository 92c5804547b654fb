// SPDX-License-Identifier: BSD-3-Clause
// How the points of a LAZ file are compressed: what the record "laszip encoded" among its variable length records says.
#pragma once

#include <pcl_bsh/io/clouds/las/laz/item.h>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace pcl_bsh::io::laz {

inline constexpr std::string_view laz_user = "laszip encoded";
inline constexpr std::uint16_t laz_id = 22204;

struct Scheme {
  struct Part {
    NewPointwise* pointwise; ///< one of these two
    NewLayered* layered;
    std::size_t size; ///< in bytes of a record
    unsigned version;
  };

  bool in_chunks = true; ///< all points are one chunk otherwise
  bool layered = false;
  std::uint32_t chunk_points = 0; ///< 0: chunks differ, as the table of chunks says, or there is one
  std::vector<Part> parts;        ///< of a record, one behind the other
};

/// @param record its content, without its head. @param record_length of a point
/// @throws FormatError for what is not read, by its name, and for what does not make up a record
Scheme parseScheme(std::string_view record, std::size_t record_length);

} // namespace pcl_bsh::io::laz
