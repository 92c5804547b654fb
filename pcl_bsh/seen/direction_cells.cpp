// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/direction_cells.h>

namespace pcl_bsh {

bool Cone::meets(const DirectionCell& cell) const
{
  constexpr double slack = 0x1p-40;
  const std::array<Eigen::Vector3d, 4> corners = cell.corners();
  const Eigen::Vector3d center = corners[0] + corners[2];
  bool inside = true;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if (direction.dot(a) >= (cosine - slack) * a.norm()) return true;
    const Eigen::Vector3d normal = a.cross(b); // of the edge's plane
    const double side = normal.dot(center) < 0.0 ? -normal.dot(direction) : normal.dot(direction);
    if (side >= 0.0) continue;
    inside = false;
    const bool is_beside = normal.cross(a).dot(direction) >= 0.0 && b.cross(normal).dot(direction) >= 0.0;
    if (is_beside && -side <= sine * normal.norm() + slack * normal.norm()) return true;
  }
  return inside;
}

unsigned cellLevels(double angle)
{
  unsigned levels = 6;
  while (std::ldexp(angle, static_cast<int>(levels)) < 8.0) ++levels;
  return levels;
}

} // namespace pcl_bsh
