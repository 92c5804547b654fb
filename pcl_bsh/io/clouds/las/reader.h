// SPDX-License-Identifier: BSD-3-Clause
// LAS files read in batches of points, so that memory does not grow with the file.
//
//   LasReader reader(openBytes("site.las"));
//   std::vector<std::uint8_t> batch(1000 * reader.header().point_step);
//   while (std::size_t points = reader.read(batch.data(), 1000)) use(batch, points);
#pragma once

#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/las/fields.h>
#include <pcl_bsh/io/clouds/las/header.h>

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// LAS 1.0 to 1.4, point formats 0 to 10, and LAZ, as the LAS that was compressed (unpacked_laz.h). Places and lengths
/// in the header are checked against the file's size before anything is read there. If a header counts more records
/// than have room before the points, those with room are taken. Bounds are not looked at; the points themselves must
/// all be there.
class LasReader : public CloudStream {
public:
  /// @param threads that unpack LAZ; 0: as many as the caller's oneTBB arena has
  /// @throws FormatError for what a header can tell; what `file` throws
  explicit LasReader(std::unique_ptr<ByteSource> file, unsigned threads = 0);

  const LasBlock& block() const noexcept { return block_; }

  /// Everything beside the points. Takes as much memory as that does in the file.
  LasHeader lasHeader() const;

  /// The fields of lasFields() and addExtraBytes().
  const pcl::PCLPointCloud2& header() const override { return cloud_; }
  std::uint64_t size() const override { return block_.points; }

  /// With remarks on points or records that the header does not count.
  CloudFacts facts() const override;

  void skip(std::uint64_t points) override { next_ += std::min(points, block_.points - next_); }
  std::size_t read(std::uint8_t* records, std::size_t most) override;
  pcl::PCLPointCloud2 readAll() override;

private:
  void findDescriptors();
  unsigned colourShift();

  std::uint64_t left_out_ = 0; ///< points of chunks that the header does not count
  std::unique_ptr<ByteSource> file_;
  LasBlock block_;
  LasHeader header_; ///< all but what is behind the points
  std::vector<LasField> fields_;
  std::vector<std::uint32_t> offsets_; ///< of fields_, in the cloud's records
  pcl::PCLPointCloud2 cloud_;
  std::uint64_t next_ = 0;
  std::string records_;
  std::optional<unsigned> colour_shift_;
};

/// Whether files with this extension are read by LasReader.
inline bool isLasExtension(std::string_view extension)
{
  return extension == ".las" || extension == ".laz";
}

/// The fields of a file, as LasReader has them. @param descriptors of its extra bytes
std::vector<LasField> lasFieldsOf(const LasBlock& block, std::string_view descriptors);

} // namespace pcl_bsh::io
