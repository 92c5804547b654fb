// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/tiles/checksum.h>
#include <pcl_bsh/site/tiles/tile_file.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

namespace pcl_bsh::site {

namespace {

constexpr auto site_remedy = "copy the tile back, or make the site again";

bool isSame(const Fields& a, const Fields& b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& f, const auto& g) {
    return f.name == g.name && f.datatype == g.datatype && f.count == g.count && f.offset == g.offset;
  });
}

/// Returns the greatest value of finite points; nothing where all their values are NaN. An infinite value counts as the
/// largest number of its sign.
template <typename Real>
std::optional<double> greatestOf(const pcl::PCLPointCloud2& cloud, const PointsView& view, std::size_t offset)
{
  constexpr double most = std::numeric_limits<double>::max();
  std::optional<double> greatest;
  for (std::uint32_t i = 0; i < view.count; ++i) {
    Real real;
    std::memcpy(&real, cloud.data.data() + std::size_t{i} * cloud.point_step + offset, sizeof real);
    const auto value = static_cast<double>(real);
    if (std::isnan(value) || (greatest && value <= *greatest) || !isFinite(view.point(i))) continue;
    greatest = std::clamp(value, -most, most);
  }
  return greatest;
}

/// Returns the longest header, which holds the place while the number of points is not known.
std::string longestHead(const Fields& fields)
{
  return io::binaryPcdHeader(fields, static_cast<std::uint32_t>(io::max_points));
}

} // namespace

TileFile::TileFile(files::NewFile& file, const Fields& fields, std::size_t buffer) : TileFile(file, fields, buffer, 0)
{
  file_->append(longestHead(fields_));
}

TileFile::TileFile(files::NewFile& file, const Fields& fields, std::size_t buffer, std::uint64_t points)
: file_(&file),
  fields_(fields),
  limit_(buffer),
  head_bytes_(longestHead(fields).size()),
  points_(points)
{
}

std::uint64_t TileFile::bytesOf(const Fields& fields, std::uint64_t points)
{
  return longestHead(fields).size() + points * layoutOf(fields).point_step;
}

void TileFile::flush()
{
  if (!buffer_.empty()) file_->append(buffer_);
  buffer_.clear();
}

void TileFile::add(const std::uint8_t* record, std::size_t bytes)
{
  if (buffer_.size() + bytes > limit_) flush();
  if (buffer_.capacity() < limit_) buffer_.reserve(limit_);
  buffer_.append(reinterpret_cast<const char*>(record), bytes);
  ++points_;
}

void TileFile::finish()
{
  flush();
  buffer_ = std::string();
  file_->replaceHead(io::binaryPcdHeader(fields_, static_cast<std::uint32_t>(points_), head_bytes_));
}

std::uint64_t diskSpaceOf(const Fields& fields, std::uint64_t points, std::uint64_t tiles, std::uint64_t overview)
{
  constexpr std::uint64_t block = 4096; // of most disks: each file fills its last one, and has a header
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / 2;
  const std::uint64_t step = layoutOf(fields).point_step, records = points + overview;
  return (records > most / step ? most : records * step) + (tiles + 2) * block;
}

std::string tileFileName(std::size_t tile)
{
  char name[32];
  std::snprintf(name, sizeof name, "/tile_%06zu.pcd", tile);
  return std::string(tiles_folder_name) + name;
}

std::filesystem::path answerFileName(std::size_t tile)
{
  return std::filesystem::path(tileFileName(tile)).replace_extension(answer_extension);
}

std::unique_ptr<io::CloudStream> openRecords(const std::filesystem::path& path, const Fields& fields)
{
  auto stream = io::openCloud(path, 0);
  if (!isSame(stream->header().fields, fields))
    throw files::FileError(path, "has other fields than the site says", site_remedy);
  return stream;
}

std::unique_ptr<io::CloudStream> openTile(const std::filesystem::path& path, const Fields& fields, std::uint64_t points)
{
  auto stream = openRecords(path, fields);
  if (stream->size() != points) {
    throw files::FileError(
        path, "has " + counted(stream->size(), "point") + ", the site says " + std::to_string(points), site_remedy);
  }
  return stream;
}

pcl::PCLPointCloud2 loadTile(const std::filesystem::path& path, const Fields& fields, std::uint64_t points,
                             pcl::PCLPointCloud2 reused)
{
  const auto stream = openTile(path, fields, points);
  pcl::PCLPointCloud2 cloud = stream->header();
  cloud.data = std::move(reused.data);
  io::resizeRecords(cloud, static_cast<std::uint32_t>(points));
  stream->read(cloud.data.data(), cloud.width);
  return cloud;
}

pcl::PCLPointCloud2 readTile(const Site& site, const Tile& tile, pcl::PCLPointCloud2 reused)
{
  pcl::PCLPointCloud2 cloud = loadTile(site.folder / tile.file, site.fields, tile.points, std::move(reused));
  if (crcOf(cloud.data) != tile.crc32)
    throw files::FileError(site.folder / tile.file, "its points are not those that the site was made with",
                           site_remedy);
  return cloud;
}

std::size_t recordBytes(const Site& site)
{
  return layoutOf(site.fields).point_step;
}

void measureExtremes(const pcl::PCLPointCloud2& cloud, Tile& tile)
{
  const PointsView view = viewOf(cloud);
  tile.bounds.reset();
  for (std::uint32_t i = 0; i < view.count; ++i) {
    const Point3 point = view.point(i);
    if (isFinite(point)) extend(tile.bounds, point);
  }
  tile.greatest.clear();
  for (const auto& field : cloud.fields) {
    if (field.count != 1 || isAxis(field.name)) continue;
    std::optional<double> greatest;
    if (field.datatype == pcl::PCLPointField::FLOAT32) greatest = greatestOf<float>(cloud, view, field.offset);
    if (field.datatype == pcl::PCLPointField::FLOAT64) greatest = greatestOf<double>(cloud, view, field.offset);
    if (greatest) tile.greatest[field.name] = *greatest;
  }
}

void measure(const pcl::PCLPointCloud2& cloud, Tile& tile)
{
  measureExtremes(cloud, tile);
  tile.spacing = spacingOf(SphereHierarchy(viewOf(cloud))).median;
  tile.crc32 = crcOf(cloud.data);
}

} // namespace pcl_bsh::site
