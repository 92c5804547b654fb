// SPDX-License-Identifier: BSD-3-Clause
// A cloud of any size on disk, cut into tiles: a folder with `site.json` and a binary PCD file for each tile.
//
//   site::Site site = site::readSite("valley");
//   for (const site::Tile& tile : site.tiles) pcl::PCLPointCloud2 points = site::readTile(site, tile);
//
// Each point has all fields of its source, and two more: `source` and `record`, UINT32, which say which record of which
// source it was, both counted from 0. In a tile points are in the order of (source, record).
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/io/files/file_error.h>

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// The names in a site's folder, and of the two fields that each of its points has.
inline constexpr const char* site_file_name = "site.json";
inline constexpr const char* overview_file_name = "overview.pcd";
inline constexpr const char* tiles_folder_name = "tiles";
inline constexpr const char* source_field_name = "source";
inline constexpr const char* record_field_name = "record";
/// The version of the folder's format. Versions 1 and 2 are read, too: they know no `coordinate_system`, and 1 knows no
/// `greatest`.
inline constexpr int site_version = 3;

/// Both corners inclusive, in the clouds' unit.
struct Bounds {
  Point3 low, high;

  /// Grows to hold it.
  void add(const Point3& point)
  {
    for (std::size_t k = 0; k < 3; ++k) {
      if (point[k] < low[k]) low[k] = point[k];
      if (point[k] > high[k]) high[k] = point[k];
    }
  }
};

/// Lets `bounds` hold the point, too.
inline void extend(std::optional<Bounds>& bounds, const Point3& point)
{
  if (!bounds) bounds = Bounds{point, point};
  bounds->add(point);
}

/// A point of a site.
struct SitePoint {
  std::uint32_t source = 0, record = 0;
  /// By source, then by record.
  bool operator<(const SitePoint& other) const noexcept
  {
    return source != other.source ? source < other.source : record < other.record;
  }
  bool operator==(const SitePoint& other) const noexcept { return source == other.source && record == other.record; }
};

/// A file that the site was made of.
struct Source {
  std::string file;
  std::uint64_t points = 0;
  /// Its fields, side by side, without padding. Fields with a question's answers are left out (result_site.h).
  std::vector<pcl::PCLPointField> fields;
  std::string coordinate_system = {}; ///< as the file named it; empty: it did not
};

/// A part of a site: one file.
struct Tile {
  std::string file; ///< relative to the site's folder
  std::uint64_t points = 0;
  std::optional<Bounds> bounds; ///< of its finite points
  double spacing = 0.0;         ///< median distance of a sample of its points to the nearest other
  std::uint32_t crc32 = 0;      ///< of its records
  /// For each field of one floating-point number, except coordinates: its greatest value among finite points. A field
  /// that is NaN for all of them has no entry.
  std::map<std::string, double> greatest;
};

/// The contents of site.json.
struct Site {
  std::filesystem::path folder;
  std::uint64_t points = 0;
  std::optional<Bounds> bounds;
  std::vector<pcl::PCLPointField> fields; ///< of the records of all tiles, side by side
  std::vector<Source> sources;
  std::vector<Tile> tiles;
};

/// Reads a folder's site.json, and checks that the tiles' files are there.
/// @throws std::runtime_error: a folder that is no site or is not complete, another version, a document that the schema
///   does not allow, numbers of points that disagree, a tile's file that is missing or lies outside the folder
Site readSite(const std::filesystem::path& folder);

/// The coordinate systems that the site's sources name, each once, with "; " between them; empty where none is named.
std::string coordinateSystemOf(const Site& site);

/// The site as the text of its site.json.
std::string siteText(const Site& site);

/// The points of a tile. @throws files::FileError when its file is not what the site says of it
/// @param reused a cloud that is no longer needed: its memory is used again, which takes a third of the time
pcl::PCLPointCloud2 readTile(const Site& site, const Tile& tile, pcl::PCLPointCloud2 reused = {});

/// Bytes of a record of the site.
std::size_t recordBytes(const Site& site);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
