// SPDX-License-Identifier: BSD-3-Clause
// Notes for users about a LAS file, beside its points.
#pragma once

#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/clouds/systems/coordinate_system.h>

#include <pcl_bsh/io/text/length_unit.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The name of the coordinate system: that of a WKT record, or the citations and EPSG codes of GeoTIFF's keys, which
/// the header's global encoding chooses between where both are there. In ASCII, with '?' for other letters. Empty where
/// it is missing or damaged.
std::string coordinateSystemOf(const LasHeader& header);

/// The system with its name and as PROJ reads it: the WKT, or EPSG's codes of the keys. It has no definition where the
/// keys give a system without a code, and the file has no WKT. A code of heights is used only where heights are in
/// metres, the only unit that is sure.
CoordinateSystem systemOf(const LasHeader& header);

/// The name of the whole system in WKT, in ASCII, too; or empty.
std::string nameOfWkt(std::string_view text);

/// The unit of x, y and z by a coordinate system as well-known text, of either version. None for angles, for a unit
/// that has no name here, and where heights have another one than places.
std::optional<LengthUnit> unitOfWkt(std::string_view text);

/// The unit of its x, y and z, by the record that names the coordinate system. Not known without such a record, for
/// angles, for a unit without a name in length_unit.h, and where heights have another one than places.
std::optional<LengthUnit> unitOf(const LasHeader& header);

/// How many records behind the points the header does not count, if any.
std::vector<std::string> remarksOn(const LasBlock& block, std::uint64_t file_bytes);

} // namespace pcl_bsh::io
