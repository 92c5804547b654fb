// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/systems/coordinate_system.h>
#include <pcl_bsh/io/text/format_error.h>

namespace pcl_bsh::io {

void requireSystem(const std::string& text)
{
  if (!text.empty() && text != no_system) coordinateSystemNamed(text);
}

std::optional<std::string> requireOneSystem(const std::string& a, const CoordinateSystem& of_a,
                                            const CoordinateSystem& of_b, const std::string& remedy)
{
  if (of_a.name.empty() || of_b.name.empty()) return std::nullopt;
  const std::optional<bool> are_one = areOneSystem(of_a, of_b);
  const std::string both = "is in '" + of_b.name + "', and " + a + " in '" + of_a.name + "'";
  if (are_one && !*are_one) throw FormatError(both, remedy);
  if (are_one || of_a.name == of_b.name) return std::nullopt;
  return both + ": whether these are one coordinate system is not known" +
         (hasProj() ? ", for PROJ does not know both" : " without PROJ");
}

} // namespace pcl_bsh::io
