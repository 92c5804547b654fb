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

} // namespace pcl_bsh::io
