// SPDX-License-Identifier: BSD-3-Clause
// Checks that a site is whole: each point is in its tile, and each record of each source is there once.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <functional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::site {

/// Reads all tiles. Holds one of them, and a bit for each point of the site.
/// @param progress called after each tile with the points done and all points; false: stop. May be null
/// @throws files::FileError naming the first file that is not what site.json says: fields, number of points, checksum,
///   bounds, greatest values of fields, records not in order, a record that is there twice or that no source has;
///   an overview of other fields; Cancelled
void checkSite(const Site& site, const std::function<bool(std::uint64_t, std::uint64_t)>& progress = nullptr);

} // namespace pcl_bsh::site
PCL_BSH_EXPORT_END
