// SPDX-License-Identifier: BSD-3-Clause
// The state of a site that is being made, noted on the disk, so that a later run can go on.
#pragma once

#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::site {

/// All points are counted, and the tiles are planned; the plan is a file beside the state. Points before (`source`,
/// `record`) are dealt to files, and some files are measured.
struct MakeState {
  std::optional<Bounds> bounds;
  std::uint32_t plan_crc32 = 0;
  std::uint32_t source = 0, record = 0;         ///< the next point to deal
  std::uint64_t dealt = 0, overview = 0;        ///< points in tiles; points in the overview
  std::vector<std::uint64_t> files;             ///< points of each
  std::vector<std::optional<std::size_t>> open; ///< of each planned tile, the file that takes its points
  std::vector<Tile> measured;                   ///< the first files
};

/// Returns the state as a document. @param question the clouds and options that the site is made of
std::string stateText(const MakeState& state, const io::Json& question);

/// Reads the state in a file. @param question the clouds and options that it must be the state of
/// @throws files::FileError where it is of another question, or damaged
MakeState readState(const std::filesystem::path& path, const io::Json& question);

/// Returns a plan as the bytes of a file, and reads it again. @throws files::FileError when it has another checksum
std::string planBytes(const std::vector<std::uint32_t>& numbers);
std::vector<std::uint32_t> readPlan(const std::filesystem::path& path, std::uint32_t crc32);

} // namespace pcl_bsh::site
