// SPDX-License-Identifier: BSD-3-Clause
#include "reading.h"

#include "program.h"

#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>

namespace pcl_bsh::cli {

void ReadOptions::addTo(CLI::App& app)
{
  app.add_option("--columns", columns_,
                 "names of the columns of .xyz, .asc, .txt and .csv, as x,y,z,_,intensity (_ is\n"
                 "not read), in place of what they say; FILE=NAMES: of that file alone;\n"
                 "may be given more than once")
      ->type_name("NAMES")
      ->allow_extra_args(false);
  app.add_flag("--allow-scale", choice_.allow_scale,
               "transforms of .ptx files may scale uniformly; they are refused\notherwise, and whatever else is no "
               "rigid motion always");
  app.add_option("--scan", choice_.scan, "of a .ptx or .e57 file only that scan, from 0; all otherwise")
      ->type_name("N");
}

io::ReadSettings ReadChoice::of(const std::filesystem::path& file) const
{
  return {columns.of(file), allow_scale, io::mayHaveScans(io::extensionOf(file)) ? scan : std::nullopt};
}

void addUnit(CLI::App& app, const std::string& option, std::optional<io::LengthUnit>& unit, const std::string& doc)
{
  app.add_option_function<std::string>(
         option,
         [option, &unit](const std::string& text) {
           try {
             unit = io::lengthUnitOf(text);
           }
           catch (const io::FormatError& error) {
             throw UsageError(option + ": " + error.what() + ": " + error.remedy());
           }
         },
         doc)
      ->type_name("UNIT");
}

void ReadOptions::addUnitsTo(CLI::App& app)
{
  addUnit(app, "--input-unit", choice_.input_unit,
          "of INPUT's lengths, and so of all that are given and told: mm, cm, m,\nft or us-ft (default: as a .las "
          "names it)");
  addUnit(app, "--obstacle-unit", choice_.obstacle_unit,
          "of OBSTACLE's lengths, which are converted to INPUT's, the fields of\nits uncertainties, too (default: as "
          "a .las names it; with neither of\nboth options nothing is converted)");
}

void ReadOptions::addSystemsTo(CLI::App& app, bool has_obstacle, const std::string& input)
{
  const auto add = [&](const std::string& option, std::string& crs, const std::string& doc) {
    app.add_option_function<std::string>(
           option,
           [option, &crs](const std::string& text) {
             try {
               io::requireSystem(crs = text);
             }
             catch (const io::FormatError& error) {
               throw UsageError(option + ": " + error.what() + ": " + error.remedy());
             }
             if (text.empty() || (option == "--to-crs" && text == io::no_system))
               throw UsageError(option + ": '" + text + "' is no system: give a code, such as EPSG:25832, or WKT");
           },
           doc)
        ->type_name("CRS");
  };
  add("--to-crs", choice_.to_crs,
      "transform " + input + (has_obstacle ? " and OBSTACLE" : "") +
          " to this projected coordinate\nsystem, as EPSG:25832 or WKT, by PROJ");
  const std::string as_named = " (default: as a\n.las or .e57 names it)";
  add("--input-crs", choice_.input_crs, "the coordinate system of " + input + as_named);
  if (has_obstacle)
    add("--obstacle-crs", choice_.obstacle_crs,
        "the coordinate system of OBSTACLE" + as_named + "; none: it has a\nframe of its own, from which poses lead");
}

ReadChoice ReadOptions::read(const std::vector<std::filesystem::path>& files) const
{
  ReadChoice choice = choice_;
  std::string text;
  try {
    for (const std::string& given : columns_) choice.columns.add(text = given);
    choice.columns.requireUsed(files);
  }
  catch (const io::FormatError& error) {
    throw UsageError("--columns: " + text + ": " + error.what() + ": " + error.remedy());
  }
  const auto may = [](const std::filesystem::path& file) { return io::mayHaveScans(io::extensionOf(file)); };
  if (choice.scan && std::none_of(files.begin(), files.end(), may))
    throw UsageError("--scan: none of the clouds is a .ptx or .e57 file, which may have several scans: leave it out");
  return choice;
}

io::ReadSettings ReadChoice::ofInput(const std::filesystem::path& file) const
{
  io::ReadSettings settings = of(file);
  settings.unit = input_unit;
  settings.crs = input_crs;
  settings.to_crs = to_crs;
  return settings;
}

io::ReadSettings ReadChoice::ofObstacle(const std::filesystem::path& file, std::optional<io::LengthUnit> unit_of_input,
                                        const std::string& sigmas) const
{
  io::ReadSettings settings = of(file);
  settings.crs = obstacle_crs;
  settings.to_crs = to_crs;
  if (!namesUnits()) return settings;
  if (!unit_of_input)
    throw UsageError(std::string("--obstacle-unit: ") + io::nameOf(*obstacle_unit) +
                     ": the unit of INPUT is not known: give --input-unit, too");
  settings.unit = obstacle_unit;
  settings.to_unit = unit_of_input;
  if (!sigmas.empty()) settings.length_fields = {sigmas};
  return settings;
}

std::string ReadChoice::unitOfReports(const std::string& name, std::optional<io::LengthUnit> unit_of_input) const
{
  if (!unit_of_input) return name;
  const std::string unit = io::nameOf(*unit_of_input);
  if (name.empty()) return unit;
  try {
    if (io::lengthUnitOf(name) != *unit_of_input)
      throw UsageError("--unit: " + name + ": lengths are in INPUT's unit, " + unit + ": leave it out");
  }
  catch (const io::FormatError&) {
    // Another word for it.
  }
  return name;
}

} // namespace pcl_bsh::cli
