// SPDX-License-Identifier: BSD-3-Clause
// A solid cylinder with flat ends.
#pragma once

#include <pcl_bsh/robot/robot.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::robots {

inline double roundness(const Cylinder&)
{
  return 0.0;
}

inline double enclosingRadius(const Cylinder& tube)
{
  return std::hypot(0.5 * tube.length, tube.radius);
}

inline double signedDistance(const Cylinder& tube, const Eigen::Vector3d& p)
{
  const double out = p.head<2>().norm() - tube.radius, over = std::abs(p.z()) - 0.5 * tube.length;
  return std::hypot(std::max(out, 0.0), std::max(over, 0.0)) + std::min(std::max(out, over), 0.0);
}

inline Eigen::Vector3d support(const Cylinder& tube, const Eigen::Vector3d& direction)
{
  const double across = direction.head<2>().norm();
  const Eigen::Vector2d rim =
      across > 0.0 ? Eigen::Vector2d(direction.head<2>() * (tube.radius / across)) : Eigen::Vector2d(tube.radius, 0.0);
  return {rim.x(), rim.y(), std::copysign(0.5 * tube.length, direction.z())};
}

inline std::array<double, 3> sizesOf(const Cylinder& tube)
{
  return {tube.radius, tube.length, tube.length};
}

} // namespace pcl_bsh::robots
