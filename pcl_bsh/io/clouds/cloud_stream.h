// SPDX-License-Identifier: BSD-3-Clause
// A cloud read from its first point to its last, in batches, so that it need not fit into memory.
//
//   auto scan = openCloud("hall.las", std::uint64_t{1} << 30);
//   std::vector<std::uint8_t> batch(1000 * scan->header().point_step);
//   while (std::size_t points = scan->read(batch.data(), 1000)) use(batch, points);
#pragma once

#include <pcl_bsh/io/clouds/read_settings.h>

#include <pcl/PCLPointCloud2.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

class CloudStream {
public:
  virtual ~CloudStream() = default;

  /// The fields of its records, as readCloud() gives them, without points.
  virtual const pcl::PCLPointCloud2& header() const = 0;

  /// Points in all.
  virtual std::uint64_t size() const = 0;

  /// Reads the next points, `most` at most, into records for which there is room.
  /// @return how many; 0 at the end. @throws files::FileError
  virtual std::size_t read(std::uint8_t* records, std::size_t most) = 0;

  /// Remarks for users about how the file is read, a line each, without its name.
  virtual std::vector<std::string> remarks() const { return {}; }

  /// As CloudFacts::coordinate_system has it.
  virtual CoordinateSystem coordinateSystem() const { return {}; }

  /// As CloudFacts::unit has it.
  virtual std::optional<LengthUnit> unit() const { return std::nullopt; }

  /// Leaves out the next points. @throws files::FileError
  virtual void skip(std::uint64_t points);
};

/// Opens any file that readCloud() reads. LAS, LAZ, E57 and binary PCD are read batch by batch, the other formats at
/// once, for which `memory`, in bytes, must hold the file and its cloud together.
/// In another coordinate system all points are read once more, for their box.
/// @param settings and @param threads as readCloud() has them
/// @throws files::FileError as readCloud() does; for a pipe; for a file that `memory` cannot hold
std::unique_ptr<CloudStream> openCloud(const std::filesystem::path& path, std::uint64_t memory,
                                       const ReadSettings& settings = {}, unsigned threads = 0);

} // namespace pcl_bsh::io
