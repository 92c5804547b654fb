// SPDX-License-Identifier: BSD-3-Clause
// Notes for users about a LAS file, beside its points.
#pragma once

#include <pcl_bsh/io/clouds/las/header.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The name of the coordinate system: that of a WKT record, or the citations and EPSG codes of GeoTIFF's keys, which
/// the header's global encoding chooses between where both are there. In ASCII, with '?' for other letters. Empty where
/// it is missing or damaged.
std::string coordinateSystemOf(const LasHeader& header);
inline std::string coordinateSystemOf(const std::shared_ptr<const LasHeader>& header) ///< null: empty
{
  return header ? coordinateSystemOf(*header) : std::string();
}

/// The name of the whole system in WKT, in ASCII, too; or empty.
std::string nameOfWkt(std::string_view text);

/// How many records behind the points the header does not count, if any.
std::vector<std::string> remarksOn(const LasBlock& block, std::uint64_t file_bytes);

} // namespace pcl_bsh::io
