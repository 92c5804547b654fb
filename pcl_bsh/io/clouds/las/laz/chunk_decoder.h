// SPDX-License-Identifier: BSD-3-Clause
// Decodes a chunk of a LAZ file into records. Chunks are independent of each other.
#pragma once

#include <pcl_bsh/io/clouds/las/laz/item.h>
#include <pcl_bsh/io/clouds/las/laz/scheme.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io::laz {

class ChunkDecoder {
public:
  /// @param scheme outlives the decoder. @param bytes of the chunk, compressed. @param points
  /// number of points, not 0; more than the scheme's chunks have: the bytes of several chunks in a
  /// row
  /// @throws FormatError, as read() does, for bytes that are not those of so many points
  ChunkDecoder(const Scheme& scheme, std::string bytes, std::uint64_t points);
  ChunkDecoder(const ChunkDecoder&) = delete;
  ChunkDecoder& operator=(const ChunkDecoder&) = delete;

  /// The next records. @param count no more than are left
  void read(char* records, std::size_t count);

private:
  struct Part {
    std::size_t at; ///< in a record
    std::unique_ptr<PointwiseItem> pointwise;
    std::unique_ptr<LayeredItem> layered;
  };

  void startChunk();
  void startLayers();

  const Scheme& scheme_;
  const std::string bytes_;
  std::uint64_t points_left_, chunk_left_ = 0; ///< behind this chunk; in it
  std::size_t at_ = 0, layers_end_ = 0;        ///< of this chunk
  std::size_t record_length_ = 0;
  std::vector<Part> parts_;
  bool at_first_ = true;
  std::optional<ArithmeticDecoder> in_; ///< of pointwise items
  std::vector<Layer> layers_;
  unsigned channel_ = 0;
};

} // namespace pcl_bsh::io::laz
