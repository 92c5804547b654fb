// SPDX-License-Identifier: BSD-3-Clause
// The first lines of OFF files.
#pragma once

#include <pcl_bsh/io/text/text_cursor.h>

#include <cstdint>
#include <string_view>

namespace pcl_bsh::io {

/// The header of an .off, before its vertices.
struct OffHeader {
  bool normals = false, colours = false, texture = false;
  bool normals_named_first = false; ///< in the keyword, as in NCOFF: some programs then write colours first
  std::uint64_t vertices = 0, faces = 0;

  /// Takes the keyword, which may be missing, and the counts: [ST][C][N]OFF, in any order of its letters; counts behind
  /// it or in the next line, also without a blank between (OFF8 12 0). The text is then at the last line of the header.
  /// @throws FormatError for what is no OFF file, for one whose vertices have not three coordinates (4OFF, nOFF), for a
  ///   binary one
  explicit OffHeader(TextCursor& text);

  /// Requires that the rest of the text can hold the vertices. Call it before memory is asked for. @throws FormatError
  void requireRoom(const TextCursor& text) const;
};

/// Whether a file begins as OFF files with a keyword do.
bool beginsAsOff(std::string_view file);

} // namespace pcl_bsh::io
