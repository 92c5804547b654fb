// SPDX-License-Identifier: BSD-3-Clause
// The binary PCD files of a site, written piece by piece.
#pragma once

#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/files/new_file.h>
#include <pcl_bsh/site/site.h>
#include <pcl_bsh/site/tiles/records.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace pcl_bsh::site {

/// A binary PCD file whose number of points is known when all are written.
class TileFile {
public:
  /// @param buffer bytes that are collected before they are written
  TileFile(files::NewFile& file, const Fields& fields, std::size_t buffer);

  /// Goes on with a file that holds so many points, all of which have been flushed.
  TileFile(files::NewFile& file, const Fields& fields, std::size_t buffer, std::uint64_t points);

  /// Returns the bytes of a file of so many points before it is finished.
  static std::uint64_t bytesOf(const Fields& fields, std::uint64_t points);

  /// Writes what is in the buffer.
  void flush();

  /// @param record of these fields, `bytes` long
  void add(const std::uint8_t* record, std::size_t bytes);

  /// Writes what is left, and the header. Frees the buffer.
  void finish();

  std::uint64_t points() const noexcept { return points_; }
  const std::filesystem::path& path() const noexcept { return file_->path(); }

private:
  files::NewFile* file_;
  Fields fields_;
  std::size_t limit_, head_bytes_;
  std::uint64_t points_ = 0;
  std::string buffer_;
};

/// Returns the bytes that the files of a site take on the disk: so many points in so many tiles, and some of them in
/// its overview.
std::uint64_t diskSpaceOf(const Fields& fields, std::uint64_t points, std::uint64_t tiles, std::uint64_t overview);

/// Returns n, where the overview has one of every n points of a site, and `most` points at most. @pre most > 0
inline std::uint64_t overviewStep(std::uint64_t points, std::uint64_t most)
{
  return points <= most ? 1 : (points - 1) / most + 1;
}

/// The name of a tile's file in the site's folder.
std::string tileFileName(std::size_t tile);

/// The name of the file with the answer about a tile. It is there while a site of results is not complete.
inline constexpr std::string_view answer_extension = ".answer";
std::filesystem::path answerFileName(std::size_t tile);

/// Opens a file of records of a site. @throws files::FileError when it has other fields
std::unique_ptr<io::CloudStream> openRecords(const std::filesystem::path& path, const Fields& fields);

/// Opens the file of a tile. @throws files::FileError when it has other fields or another number of points
std::unique_ptr<io::CloudStream> openTile(const std::filesystem::path& path, const Fields& fields,
                                          std::uint64_t points);

/// The points of a tile's file. @throws as openTile() does. @param reused as that of readTile()
pcl::PCLPointCloud2 loadTile(const std::filesystem::path& path, const Fields& fields, std::uint64_t points,
                             pcl::PCLPointCloud2 reused = {});

/// Sets bounds and the greatest values of a tile from its points.
void measureExtremes(const pcl::PCLPointCloud2& cloud, Tile& tile);

/// Sets bounds, greatest values, spacing and checksum of a tile from its points.
void measure(const pcl::PCLPointCloud2& cloud, Tile& tile);

} // namespace pcl_bsh::site
