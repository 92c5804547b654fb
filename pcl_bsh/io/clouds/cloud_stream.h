// SPDX-License-Identifier: BSD-3-Clause
// A cloud read from its first point to its last, in batches, so that it need not fit into memory.
//
//   auto scan = openCloud("hall.las", std::uint64_t{1} << 30);
//   std::vector<std::uint8_t> batch(1000 * scan->header().point_step);
//   while (std::size_t points = scan->read(batch.data(), 1000)) use(batch, points);
#pragma once

#include <pcl_bsh/io/clouds/cloud_file.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace pcl_bsh::io {

class ByteSource;

class CloudStream {
public:
  virtual ~CloudStream() = default;

  /// The fields of its records, as readCloud() gives them, without points.
  virtual const pcl::PCLPointCloud2& header() const = 0;

  /// Points in all.
  virtual std::uint64_t size() const = 0;

  /// Reads the next points, `most` at most, into records for which there is room.
  /// @return how many; 0 at the end. @throws files::FileError; FormatError where the stream knows no file
  virtual std::size_t read(std::uint8_t* records, std::size_t most) = 0;

  /// As readCloud() tells them. Scanners stay where the file has them.
  virtual CloudFacts facts() const { return {}; }

  /// Leaves out the next points. @throws as read() does
  virtual void skip(std::uint64_t points);

  /// All points, when none has been read. @throws as read() does; FormatError beyond max_points
  virtual pcl::PCLPointCloud2 readAll();
};

/// Opens any file that readCloud() reads. LAS, LAZ, E57 and binary PCD are read batch by batch, the other formats at
/// once, for which `memory`, in bytes, must hold the file and its cloud together. Where the settings want another
/// coordinate system, all points are read once more, for their box.
/// @param settings and @param threads as readCloud() has them
/// @throws files::FileError as readCloud() does; for a pipe; for a file that `memory` cannot hold
std::unique_ptr<CloudStream> openCloud(const std::filesystem::path& path, std::uint64_t memory,
                                       const ReadSettings& settings = {}, unsigned threads = 0);

/// Whether files with this extension are read from a ByteSource: .las, .laz, .e57.
bool isReadByPlace(std::string_view extension);

/// The reader of such a format. @throws FormatError for what a header can tell; what `file` throws
std::unique_ptr<CloudStream> readerByPlace(std::string_view extension, std::unique_ptr<ByteSource> file,
                                           const ReadSettings& settings, unsigned threads);

} // namespace pcl_bsh::io
