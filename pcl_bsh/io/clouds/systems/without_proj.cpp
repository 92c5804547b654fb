// SPDX-License-Identifier: BSD-3-Clause
// In place of coordinate_system.cpp and system_transform.cpp where PROJ is not found.
#include <pcl_bsh/io/clouds/systems/coordinate_system.h>
#include <pcl_bsh/io/clouds/systems/system_transform.h>
#include <pcl_bsh/io/text/format_error.h>

namespace pcl_bsh::io {

bool hasProj()
{
  return false;
}

CoordinateSystem coordinateSystemNamed(const std::string& text)
{
  throw FormatError("'" + text + "' is not known, for this was built without PROJ",
                    "build it where libproj-dev is installed");
}

std::string wkt1Of(const CoordinateSystem& system)
{
  const bool is_wkt = system.definition.find('[') != std::string::npos;
  return is_wkt ? system.definition : std::string();
}

std::optional<bool> areOneSystem(const CoordinateSystem& a, const CoordinateSystem& b)
{
  return !a.definition.empty() && a.definition == b.definition ? std::optional(true) : std::nullopt;
}

struct SystemTransform::Proj {};

SystemTransform::SystemTransform(const CoordinateSystem&, const std::string& to, const Eigen::AlignedBox3d&,
                                 std::optional<LengthUnit>)
{
  target_ = coordinateSystemNamed(to); // which throws
}

void SystemTransform::operator()(std::span<Point3>, std::uint64_t) const
{
}

SystemTransform::~SystemTransform() = default;

} // namespace pcl_bsh::io
