// SPDX-License-Identifier: BSD-3-Clause
// A capsule is a segment with a radius.
#pragma once

#include <pcl_bsh/robot/robot.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::robots {

inline double roundness(const Capsule& pill)
{
  return pill.radius;
}

inline double enclosingRadius(const Capsule& pill)
{
  return 0.5 * pill.length + pill.radius;
}

inline double signedDistance(const Capsule& pill, const Eigen::Vector3d& p)
{
  const double beyond = std::max(std::abs(p.z()) - 0.5 * pill.length, 0.0);
  return std::sqrt(p.x() * p.x() + p.y() * p.y() + beyond * beyond) - pill.radius;
}

inline Eigen::Vector3d support(const Capsule& pill, const Eigen::Vector3d& direction)
{
  return {0.0, 0.0, std::copysign(0.5 * pill.length, direction.z())};
}

inline std::array<double, 3> sizesOf(const Capsule& pill)
{
  return {pill.radius, pill.length, pill.length};
}

} // namespace pcl_bsh::robots
