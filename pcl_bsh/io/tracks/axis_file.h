// SPDX-License-Identifier: BSD-3-Clause
// Axes from files: measured points, elements as text, or an alignment of LandXML.
#pragma once

#include <pcl_bsh/track/axis.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pcl_bsh::io {

/// The lines that cant turns about, by the words of files and options.
inline const std::vector<std::pair<std::string, CantPivot>> cant_pivots = {{"low_rail", CantPivot::low_rail},
                                                                           {"centre", CantPivot::centre}};

/// None for any other word.
std::optional<CantPivot> cantPivotOf(std::string_view word);

struct AxisSettings {
  std::string alignment = {};                     ///< its name in LandXML; empty: the only one
  std::optional<double> cant_unit = std::nullopt; ///< unit of cants, in units of length; none: 0.001 in LandXML, else 1
  std::optional<double> gauge = std::nullopt;     ///< instead of the file's
  std::optional<CantPivot> pivot = std::nullopt;  ///< instead of the file's
  std::optional<double> fit = std::nullopt; ///< of points: few arcs within this distance; none: arcs through each point
};

/// Reads an axis, by the file's extension:
///
/// .csv        points, a line each, as a first line names their columns: chainage, x y z (also E N H) and, if there,
///             cant. Arcs go through them, or near them by `fit`
/// .xml        LandXML's Alignment: CoordGeom with Line, Curve and Spiral (clothoid), ProfAlign with PVI and ParaCurve,
///             Cant, StaEquation
/// others      elements, as parseElements() has them
/// @param remarks what users should know of how it was read, without the file's name
/// @throws files::FileError naming the file, the line or the distance, the value, and what to do
Axis readAxis(const std::filesystem::path& path, const AxisSettings& settings = {},
              std::vector<std::string>* remarks = nullptr);

/// Elements as text: a word and its numbers in each line. A # begins a comment.
///
/// - angle UNIT: of bearings, deg (default), gon or rad
/// - start X Y BEARING: bearings count clockwise from y
/// - chainage C: of the start, 0 otherwise
/// - straight LENGTH
/// - arc LENGTH RADIUS: radii are positive where the line turns to the right
/// - clothoid LENGTH FROM TO: radii at its ends, inf of a straight
/// - height C Z [LENGTH]: grades meet at that chainage, in a parabola of that length
/// - cant C VALUE: the left rail is so much higher; ramps between
/// - equation C AHEAD: from here on chainages count from AHEAD
/// - gauge LENGTH, pivot low_rail, pivot centre
///
/// Chainages C count on from the start, without the jumps of equations.
/// @throws FormatError naming the line
AxisDescription parseElements(std::string_view text);

/// An alignment of LandXML. @throws FormatError naming the line
AxisDescription parseLandXml(std::string_view text, const AxisSettings& settings, std::vector<std::string>& remarks);

} // namespace pcl_bsh::io
