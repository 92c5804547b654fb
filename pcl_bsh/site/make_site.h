// SPDX-License-Identifier: BSD-3-Clause
// Makes a site of clouds of any size, in two passes over their files: one counts where points lie, the other deals them
// to the tiles.
//
//   site::MakeOptions options;
//   options.memory = std::uint64_t{2} << 30;
//   site::Site site = site::makeSite({"north.las", "south.las"}, "valley", options);
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// Points are counted, dealt to their tiles, and the tiles measured.
enum class MakeStep : std::uint8_t { count, deal, measure };

/// How large tiles are, and what making them may take.
struct MakeOptions {
  std::uint64_t memory = std::uint64_t{2} << 30; ///< bytes that may be held at once; at least 64 MiB
  std::uint64_t tile_points = 4'000'000;         ///< no tile has more; from 1 to 2^31 - 1
  std::uint64_t overview_points = 1'000'000;     ///< most in overview.pcd, drawn evenly; 0: it is not written
  /// Points between two notes of the state in the folder, from which a later run can go on. Sites of fewer points begin
  /// again. At least 1.
  std::uint64_t save_points = 50'000'000;
  /// Takes the vertices alone of files with faces; else such files are refused, because a site holds no surface.
  bool vertices_only = false;
  bool allow_scale = false;             ///< transforms of .ptx files may scale uniformly; else they are refused
  unsigned threads = 0;                 ///< that unpack LAZ; 0: all of the machine's
  std::optional<std::size_t> scan = {}; ///< of .ptx and .e57 files only that one, from 0
  /// Names of a cloud's columns, as readCloud() takes them; null: as the files say.
  std::function<std::vector<std::string>(const std::filesystem::path&)> columns;

  /// The unit of the clouds' lengths, and that of the site's: mm, cm, m, ft or us-ft. Empty: the unit that files name,
  /// and lengths as they are.
  std::string unit;
  std::string to_unit; ///< see unit
  /// The clouds' coordinate system, and the projected one to which PROJ transforms them, as EPSG:25832 or WKT; each
  /// file is read once more for that. Empty: the system that files name, and coordinates as they are. Not with units.
  std::string crs;
  std::string to_crs; ///< see crs
  /// Called with a cloud and remarks for users about how it is read; null: not told.
  std::function<void(const std::filesystem::path&, const std::vector<std::string>& remarks)> remark;
  /// Called now and then with the points done and all points of this step. False: stop, makeSite() throws Cancelled.
  std::function<bool(MakeStep, std::uint64_t done, std::uint64_t all)> progress;
};

/// Reads clouds (all formats of readCloud(), from files) and makes a folder of tiles. A tile holds the points in some
/// neighbouring voxels of one grid, at most `tile_points`. Points that are not finite have tiles of their own. The
/// folder is made, or is empty, or holds the state of an earlier run: with equal clouds and options, it goes on from
/// there. When anything is thrown before a state was noted, nothing new is left in the folder.
/// @throws files::FileError: clouds that cannot be read, have faces, or change meanwhile; fields of one name and
///   different types; formats that must be held in memory, and do not fit; a folder that holds anything else, or cannot
///   be written; a disk that has no room for the site;
///   std::invalid_argument for options; Cancelled
Site makeSite(const std::vector<std::filesystem::path>& clouds, const std::filesystem::path& folder,
              const MakeOptions& options = {});

/// Whether makeSite() would go on with what an earlier run has noted in a folder.
bool isBegun(const std::filesystem::path& folder);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
