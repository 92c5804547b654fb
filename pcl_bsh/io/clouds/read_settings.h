// SPDX-License-Identifier: BSD-3-Clause
// Settings of how a file of points is read, beside what the file says itself.
#pragma once

#include <pcl_bsh/io/clouds/systems/coordinate_system.h>
#include <pcl_bsh/io/text/column_names.h>
#include <pcl_bsh/io/text/length_unit.h>

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pcl_bsh::io {

struct ReadSettings {
  ReadSettings() = default;
  ReadSettings(ColumnNames names, bool scale = false, std::optional<std::size_t> one = {})
  : columns(std::move(names)),
    allow_scale(scale),
    scan(one)
  {
  }
  ReadSettings(std::initializer_list<const char*> names) : columns(names.begin(), names.end()) {}

  ColumnNames columns;                  ///< of .xyz, .asc, .txt and .csv; empty: as the file says
  bool allow_scale = false;             ///< transforms of a .ptx may scale uniformly (rigid_pose.h)
  std::optional<std::size_t> scan = {}; ///< of a .ptx or .e57 only that one, from 0; of a .ptx as an organised cloud
  bool beams = false; ///< directions of an .e57's beams without a return are read into the fields beam_field_names

  /// The unit of the file's lengths; none: as the coordinate system of a .las tells.
  std::optional<LengthUnit> unit = {};
  /// The unit into which lengths are converted: x y z and `length_fields`, which become float64, and places of
  /// scanners. None: they stay as they are.
  std::optional<LengthUnit> to_unit = {};
  std::vector<std::string> length_fields = {}; ///< more fields that are lengths, such as radii and sigmas

  /// The coordinate system of the file, or no_system; empty: as a .las or .e57 names it.
  std::string crs = {};
  /// The system into which coordinates, which become float64, and places of scanners are transformed. Empty: they stay
  /// as they are. Not together with units.
  std::string to_crs = {};

  bool converts() const { return unit || to_unit || !crs.empty() || !to_crs.empty(); }
  bool transforms() const { return !to_crs.empty() && crs != no_system; }
};

/// The scale from the file's lengths to those that are wanted. @param told unit that the file itself names
/// @param remarks gets a line where lengths change, and where the file names another unit than the settings
/// @throws FormatError where a unit is wanted, and nobody tells the file's own
LengthScale scaleOf(const ReadSettings& settings, std::optional<LengthUnit> told,
                    std::vector<std::string>* remarks = nullptr);

/// The coordinate system of a file. @param told as the file names it
/// @param remarks gets a line where the settings name another
/// @throws FormatError where another is wanted, and nobody tells the file's own; for units beside that
CoordinateSystem systemOf(const ReadSettings& settings, const CoordinateSystem& told,
                          std::vector<std::string>* remarks = nullptr);

/// Whether files with this extension, in small letters, may have several scans.
inline bool mayHaveScans(std::string_view extension)
{
  return extension == ".ptx" || extension == ".e57";
}

} // namespace pcl_bsh::io
