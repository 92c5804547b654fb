// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/read_settings.h>
#include <pcl_bsh/io/text/format_error.h>

namespace pcl_bsh::io {

LengthScale scaleOf(const ReadSettings& settings, std::optional<LengthUnit> told, std::vector<std::string>* remarks)
{
  const std::optional<LengthUnit> from = settings.unit ? settings.unit : told;
  const auto remark = [&](const std::string& text) {
    if (remarks) remarks->push_back(text);
  };
  if (from && told && from != told)
    remark(std::string("its coordinate system is in ") + nameOf(*told) + ": it is read as " + nameOf(*from) +
           ", as was given");
  if (!settings.to_unit) return {};
  if (!from) {
    throw FormatError(std::string("does not say its unit, and is wanted in ") + nameOf(*settings.to_unit),
                      std::string("name its unit, too: ") + length_units);
  }
  const LengthScale scale(*from, *settings.to_unit);
  if (!scale.isOne())
    remark(std::string("its lengths are converted from ") + nameOf(*from) + " to " + nameOf(*settings.to_unit));
  return scale;
}

CoordinateSystem systemOf(const ReadSettings& settings, const CoordinateSystem& told, std::vector<std::string>* remarks)
{
  if (settings.crs == no_system) return {};
  if (settings.transforms() && (settings.unit || settings.to_unit))
    throw FormatError("is wanted in the coordinate system " + settings.to_crs + " and in units, too",
                      "give the system alone, which has a unit");
  if (!settings.crs.empty()) {
    CoordinateSystem given = coordinateSystemNamed(settings.crs);
    if (remarks && !told.name.empty() && !areOneSystem(told, given).value_or(false))
      remarks->push_back("its coordinate system is '" + told.name + "': it is read as '" + given.name +
                         "', as was given");
    return given;
  }
  if (settings.transforms() && told.definition.empty()) {
    const std::string wanted = ", and is wanted in " + settings.to_crs;
    throw FormatError((told.name.empty() ? "names no coordinate system"
                                         : "names the coordinate system '" + told.name + "', but does not define it") +
                          wanted,
                      "name its system, too (`crs`, --input-crs, --obstacle-crs)");
  }
  return told;
}

} // namespace pcl_bsh::io
