// SPDX-License-Identifier: BSD-3-Clause
// How command lines say how files of points are read.
#pragma once

#include <pcl_bsh/io/clouds/read_settings.h>

#include <CLI/CLI.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The settings of each file that a program reads.
struct ReadChoice {
  io::ColumnChoice columns;
  bool allow_scale = false;
  std::optional<std::size_t> scan = {};                              ///< of files that may have several
  std::optional<io::LengthUnit> input_unit = {}, obstacle_unit = {}; ///< as given
  std::string input_crs = {}, obstacle_crs = {}, to_crs = {};        ///< as given

  bool namesUnits() const { return input_unit || obstacle_unit; }

  io::ReadSettings of(const std::filesystem::path& file) const;

  /// The settings of the input: it keeps its coordinate system, or gets to_crs. Its unit is that of all lengths.
  io::ReadSettings ofInput(const std::filesystem::path& file) const;

  /// The settings of an obstacle: where a unit is given, it is converted to the input's.
  /// @param input_unit as the input was read. @param sigmas the field of its uncertainties, or empty
  /// @throws UsageError where the unit is not known
  io::ReadSettings ofObstacle(const std::filesystem::path& file, std::optional<io::LengthUnit> input_unit,
                              const std::string& sigmas) const;

  /// The unit's name in reports: the given one or, where it is known, the input's. @throws UsageError where these are
  /// different units
  std::string unitOfReports(const std::string& name, std::optional<io::LengthUnit> input_unit) const;
};

/// Adds an option whose value is a unit.
void addUnit(CLI::App& app, const std::string& option, std::optional<io::LengthUnit>& unit, const std::string& doc);

/// --columns, --allow-scale, --scan and units as they are written.
class ReadOptions {
public:
  void addTo(CLI::App& app);

  /// --input-unit and --obstacle-unit.
  void addUnitsTo(CLI::App& app);

  /// --to-crs and --input-crs; --obstacle-crs where there is one. @param input its name in the help
  void addSystemsTo(CLI::App& app, bool has_obstacle, const std::string& input = "INPUT");

  /// @param files that the program reads clouds from
  /// @throws UsageError for what is no list of names, for names that none of the files can have, and for a scan where
  /// none may have several
  ReadChoice read(const std::vector<std::filesystem::path>& files) const;

private:
  std::vector<std::string> columns_; ///< as given
  ReadChoice choice_;                ///< all other options
};

} // namespace pcl_bsh::cli
