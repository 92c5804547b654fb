// SPDX-License-Identifier: BSD-3-Clause
// E57 files read in batches of points, so that memory does not grow with the file.
#pragma once

#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/e57/contents.h>
#include <pcl_bsh/io/clouds/e57/streams.h>

namespace pcl_bsh::io {

/// All scans of a file in their common frame, one after the other, or one of them. Fields:
///
/// x y z                         float64, of Cartesian or else of spherical coordinates, by the scan's pose. NaN where
///                               the file calls them invalid: no point, or a direction alone.
/// beam_x beam_y beam_z          float32, that direction in the common frame, of length 1; 0 0 0 of all others. Where
///                               they are asked for.
/// rgb                           of colorRed colorGreen colorBlue, by the file's limits. Beside it are red green blue,
///                               where these are more than bytes.
/// normal_x normal_y normal_z    of the extension nor:, turned as the points are.
/// scan                          uint16, from 0; of several scans.
///
/// All other values have the file's names, an extension's with its prefix as `ext_name`. Integers have the least type
/// that holds their limits, scaled integers are float64. A scan that lacks a value has NaN, or 0 where it is an
/// integer. Texts are left out.
class E57Reader : public CloudStream {
public:
  /// @param scan only that one, from 0. @param beams whether directions without a range are read
  /// @throws FormatError for what pages and XML can tell; what `file` throws
  explicit E57Reader(std::unique_ptr<ByteSource> file, std::optional<std::size_t> scan = {}, bool beams = false);

  E57Reader(const E57Reader&) = delete; // its streams read its pages
  E57Reader& operator=(const E57Reader&) = delete;

  const pcl::PCLPointCloud2& header() const override { return cloud_; }
  std::uint64_t size() const override { return size_; }

  /// Facts about all scans that are read; the viewpoint is that of the first. There are no scanners where one scan has
  /// points but neither a pose nor spherical coordinates: it may be merged of several.
  CloudFacts facts() const override;

  std::size_t read(std::uint8_t* records, std::size_t most) override;

private:
  void layOut(bool beams);
  void requireRoom();
  void beginScan();
  void readBatch(std::uint8_t* records, std::size_t points);
  void putBeams(std::uint8_t* records, std::size_t points);
  std::vector<double>& column(E57Column name) { return columns_[static_cast<std::size_t>(name)]; }

  E57Pages pages_;
  E57Contents contents_; ///< of the scans that are read
  pcl::PCLPointCloud2 cloud_;
  std::uint64_t size_ = 0, next_ = 0; ///< all points; the next of the scan
  std::size_t scan_ = 0;
  std::optional<E57Streams> streams_;                      ///< of the scan, once it is begun
  std::optional<std::size_t> beams_at_;                    ///< in a record
  std::vector<const pcl::PCLPointField*> fields_, absent_; ///< the field of each stream, or null; fields without stream
  std::array<std::vector<double>, static_cast<std::size_t>(E57Column::none)> columns_;
};

} // namespace pcl_bsh::io
