// SPDX-License-Identifier: BSD-3-Clause
// A site as one data set of VTK in pieces, which ParaView reads in parallel.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <filesystem>
#include <functional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// Writes NAME.pvtp, and beside it a folder NAME with a .vtp file for each tile: its finite points as one poly-vertex
/// cell, and all other fields as point arrays. Holds one tile. NAME.pvtp appears when all pieces are there; when
/// anything is thrown, nothing is left.
/// @param file with the extension .pvtp
/// @param progress called after each tile with the points done and all points; false: stop. May be null
/// @throws files::FileError where NAME is there already and not empty; Cancelled
void exportPieces(const Site& site, const std::filesystem::path& file,
                  const std::function<bool(std::uint64_t, std::uint64_t)>& progress = nullptr);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
