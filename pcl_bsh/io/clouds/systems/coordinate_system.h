// SPDX-License-Identifier: BSD-3-Clause
// Coordinate systems of files, as PROJ knows them, where that was there when this was built.
#pragma once

#include <optional>
#include <string>

namespace pcl_bsh::io {

/// The name that settings give for coordinates in no system, whatever their file says.
inline constexpr auto no_system = "none";

struct CoordinateSystem {
  std::string name = {};       ///< for users; empty: the file names none
  std::string definition = {}; ///< codes or WKT, as PROJ reads them; empty: not known
};

/// Whether this was built with PROJ.
bool hasProj();

/// The system that users name by codes (EPSG:25832, with heights EPSG:25832+7837) or WKT.
/// @throws FormatError quoting what PROJ does not know; always without PROJ
CoordinateSystem coordinateSystemNamed(const std::string& text);

/// As coordinateSystemNamed() takes it, or `none`, or empty. @throws FormatError as it does
void requireSystem(const std::string& text);

/// Its WKT of version 1, which LAS asks for; empty where it has none, or PROJ does not know it. Without PROJ, the WKT
/// of any version that it is defined by.
std::string wkt1Of(const CoordinateSystem& system);

/// Whether both are the same, heights too where both have a system of heights. Not known where PROJ does not know one
/// of them, and without PROJ.
std::optional<bool> areOneSystem(const CoordinateSystem& a, const CoordinateSystem& b);

/// Refuses clouds of different systems.
/// @param a name of the first in messages, such as its file
/// @param remedy told where both are different
/// @return a warning where both have systems, and whether they are the same is not known
/// @throws FormatError about b
std::optional<std::string> requireOneSystem(const std::string& a, const CoordinateSystem& of_a,
                                            const CoordinateSystem& of_b, const std::string& remedy);

} // namespace pcl_bsh::io
